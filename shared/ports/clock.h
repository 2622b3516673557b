#pragma once
// The time that a loop runs by: the system's (shared/system/monotonic_clock.h), or a virtual one.

#include <cstdint>

namespace tenon {

/// Real-time: no allocation, no throw. One thread.
class Clock {
 public:
  Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  virtual ~Clock() = default;

  /// Never decreases.
  [[nodiscard]] virtual std::int64_t now_ns() noexcept = 0;
  /// Returns once that time has come; at once where it has passed.
  virtual void wait_until_ns(std::int64_t time_ns) noexcept = 0;
};

}  // namespace tenon
