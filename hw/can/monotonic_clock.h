#pragma once
// The clock that transports stamp what they receive with. Real-time (vDSO), any thread.

#include <time.h>

#include <cstdint>

namespace tenon::hw {

[[nodiscard]] inline std::int64_t clock_now_ns(clockid_t clock) noexcept {
  timespec now{};
  ::clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

[[nodiscard]] inline std::int64_t monotonic_now_ns() noexcept {
  return clock_now_ns(CLOCK_MONOTONIC);
}

/// A kernel's time stamp (CLOCK_REALTIME) as monotonic time.
[[nodiscard]] inline std::int64_t monotonic_of_realtime_ns(std::int64_t realtime_ns) noexcept {
  return realtime_ns + (monotonic_now_ns() - clock_now_ns(CLOCK_REALTIME));
}

}  // namespace tenon::hw
