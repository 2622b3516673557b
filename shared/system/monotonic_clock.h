#pragma once
// The clock, CLOCK_MONOTONIC. Real-time (vDSO; the wait sleeps as asked), no allocation, any
// thread. Only loops that run in real time, transports and mains read it; elsewhere time is an
// argument.

#include <cstdint>

#include "shared/ports/clock.h"

namespace tenon {

[[nodiscard]] std::int64_t monotonic_now_ns() noexcept;

/// Sleeps to an absolute time; returns at once where it has passed.
void wait_until_ns(std::int64_t monotonic_ns) noexcept;

/// The same as a loop's clock.
class MonotonicClock final : public Clock {
 public:
  [[nodiscard]] std::int64_t now_ns() noexcept override { return monotonic_now_ns(); }
  void wait_until_ns(std::int64_t time_ns) noexcept override { tenon::wait_until_ns(time_ns); }
};

/// CLOCK_REALTIME, us since 1970: for people, not for motion.
[[nodiscard]] std::int64_t wall_clock_us() noexcept;

/// A kernel's time stamp (CLOCK_REALTIME) as monotonic time.
[[nodiscard]] std::int64_t monotonic_of_realtime_ns(std::int64_t realtime_ns) noexcept;

}  // namespace tenon
