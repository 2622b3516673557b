#pragma once
// Plan to bytes and back. FORMAT.md documents every byte.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "shared/plan/plan.h"

namespace tenon {

/// The numbers stand in messages and tests only.
enum class PlanError : std::uint8_t {
  kNone = 0,
  kTooShort = 1,    ///< fewer bytes than a header
  kMagic = 2,       ///< not a plan
  kVersion = 3,     ///< another format version
  kLength = 4,      ///< the length in the header is not the length of the bytes
  kChecksum = 5,    ///< CRC-32C
  kTruncated = 6,   ///< a record runs past the end
  kTrailing = 7,    ///< bytes after the last record
  kCount = 8,       ///< a count is outside its range
  kNotFinite = 9,   ///< NaN or infinity
  kRange = 10,      ///< a value is outside its range
  kIndex = 11,      ///< a parameter set that does not exist
  kSuccessor = 12,  ///< a successor that is not a greater step, done or fail
  kText = 13,       ///< a name that is not printable text
};
[[nodiscard]] const char* to_string(PlanError error);

struct DecodedPlan {
  std::optional<Plan> plan;  ///< empty where error is not kNone
  PlanError error = PlanError::kNone;
  std::size_t offset = 0;  ///< byte where it was noticed
  std::string field;       ///< the field's name in FORMAT.md
};

/// Trusts nothing: any truncation, flipped bit, or bad value is an error. Allocates no more than
/// the bytes justify.
[[nodiscard]] DecodedPlan decode_plan(std::span<const std::uint8_t> bytes);

/// @throws InputError where the plan cannot be represented (too many steps, a name too long, a
/// value that decode_plan() would refuse).
[[nodiscard]] std::vector<std::uint8_t> encode_plan(const Plan& plan);

}  // namespace tenon
