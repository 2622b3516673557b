#include "lcmtypes/received/received.h"

namespace tenon {
namespace {

// As in lcmtypes/: what stands before the first length, the hash included.
constexpr std::size_t kBeforeJointCount = 313;
constexpr std::size_t kBeforePlan = 32;
constexpr std::size_t kEndReason = 1;
constexpr std::size_t kBeforeCounts = 81;  // of joints, 8 bits, and of steps, 16 bits

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

// The arrays behind are as long as the counts say, which decoding compares with the bytes that are
// left.
template <>
bool lengths_fit<run_setup_t>(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kNegative = 0x80;
  constexpr std::size_t kJoints = 1;
  constexpr std::size_t kSteps = 2;
  if (!skip(bytes, kBeforeCounts) || bytes.size() < kJoints + kSteps) return false;
  if (bytes[0] >= kNegative || bytes[kJoints] >= kNegative) return false;
  bytes = bytes.subspan(kJoints + kSteps);
  constexpr int kStrings = 5;
  for (int i = 0; i < kStrings; ++i) {
    if (!take_string(bytes)) return false;
  }
  return true;
}

}  // namespace tenon
