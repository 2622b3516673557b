#include "lcmtypes/received/received.h"

namespace tenon {
namespace {

// As in lcmtypes/: what stands before the first length, the hash included.
constexpr std::size_t kBeforeJointCount = 313;
constexpr std::size_t kBeforePlan = 32;
constexpr std::size_t kEndReason = 1;

/// A string: its length with a final zero, as i32 be, and its bytes. Steps over it.
bool take_string(std::span<const std::uint8_t>& bytes) {
  constexpr std::size_t kLength = 4;
  if (bytes.size() < kLength) return false;
  std::uint32_t length = 0;
  for (std::size_t i = 0; i < kLength; ++i) length = length << 8U | bytes[i];
  bytes = bytes.subspan(kLength);
  if (length == 0 || length > bytes.size() || bytes[length - 1] != 0) return false;
  bytes = bytes.subspan(length);
  return true;
}

bool skip(std::span<const std::uint8_t>& bytes, std::size_t count) {
  if (bytes.size() < count) return false;
  bytes = bytes.subspan(count);
  return true;
}

}  // namespace

template <>
bool lengths_fit<cycle_state_t>(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kNegative = 0x80;
  return skip(bytes, kBeforeJointCount) && !bytes.empty() && bytes.front() < kNegative;
}

template <>
bool lengths_fit<run_summary_t>(std::span<const std::uint8_t> bytes) {
  return skip(bytes, kBeforePlan) && take_string(bytes) && take_string(bytes) &&
         skip(bytes, kEndReason) && take_string(bytes);
}

}  // namespace tenon
