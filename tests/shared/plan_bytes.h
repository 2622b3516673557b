#pragma once
// Bytes of plans that were tampered with.

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <vector>

#include "shared/base/bytes.h"
#include "shared/base/crc32c.h"
#include "shared/plan/codec.h"

namespace tenon::tests {

using Bytes = std::vector<std::uint8_t>;

// Makes length and checksum right again, so that what lies behind them is looked at.
inline void reseal(Bytes& bytes) {
  store_le(std::span(bytes).subspan(8), static_cast<std::uint32_t>(bytes.size()));
  const std::size_t covered = bytes.size() - 4;
  store_le(std::span(bytes).subspan(covered), crc32c(std::span(bytes).first(covered)));
}

inline Plan decoded(const Bytes& bytes) {
  const DecodedPlan result = decode_plan(bytes);
  EXPECT_EQ(result.error, PlanError::kNone) << to_string(result.error) << ": " << result.field;
  return result.plan.value_or(Plan{});
}

}  // namespace tenon::tests
