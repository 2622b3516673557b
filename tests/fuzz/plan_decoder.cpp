// decode_plan() on arbitrary bytes. What it accepts is encoded back to the very same bytes.
//
// The bytes are tried as they are and with length and checksum made right, or no mutation would
// ever get past those two.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "shared/base/bytes.h"
#include "shared/base/crc32c.h"
#include "shared/plan/codec.h"
#include "tests/fuzz/support/must.h"

namespace {

using namespace tenon;
using fuzz::must;

// FORMAT.md: the length stands at byte 8, the checksum in the last four.
constexpr std::size_t kLengthOffset = 8;
constexpr std::size_t kChecksumSize = 4;

void check(std::span<const std::uint8_t> bytes) {
  const DecodedPlan decoded = decode_plan(bytes);
  must(decoded.plan.has_value() == (decoded.error == PlanError::kNone),
       "there is a plan exactly where there is no error");
  if (!decoded.plan) {
    must(decoded.offset <= bytes.size(), "an error lies within the bytes");
    must(!decoded.field.empty(), "an error names a field");
    return;
  }
  const Plan& plan = *decoded.plan;
  const std::vector<std::uint8_t> again = encode_plan(plan);
  must(std::equal(again.begin(), again.end(), bytes.begin(), bytes.end()),
       "what was decoded encodes to the same bytes");
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    static_cast<void>(move_parameters(plan, i));
    for (const OutcomeRule& rule : plan.steps[i].outcomes) {
      const bool end = rule.successor == kSuccessorDone || rule.successor == kSuccessorFail;
      must(end || (rule.successor > i && rule.successor < plan.steps.size()),
           "a successor is a later step or an end");
    }
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  check(bytes);
  if (size < kLengthOffset + sizeof(std::uint32_t) + kChecksumSize) return 0;
  std::vector<std::uint8_t> repaired(bytes.begin(), bytes.end());
  const std::span<std::uint8_t> all(repaired);
  store_le(all.subspan(kLengthOffset), static_cast<std::uint32_t>(size));
  store_le(all.last(kChecksumSize), crc32c(all.first(size - kChecksumSize)));
  check(repaired);
  return 0;
}
