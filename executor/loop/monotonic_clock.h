#pragma once
// The executor's clock, CLOCK_MONOTONIC. Real-time: system calls without allocation. Only the loop
// around the controller, the recorder's thread and the mains use it; wall_us() stamps telemetry.

#include <cerrno>
#include <cstdint>
#include <ctime>

namespace tenon::executor {

class MonotonicClock {
 public:
  [[nodiscard]] static std::int64_t now_ns() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t{now.tv_sec} * kSecond_ns + now.tv_nsec;
  }

  /// Wall-clock time for people, us since 1970. Not for motion.
  [[nodiscard]] static std::int64_t wall_us() {
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    return std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000;
  }

  /// Sleeps to an absolute time; returns at once where it has passed.
  static void wait_until(std::int64_t time_ns) {
    const timespec until{static_cast<time_t>(time_ns / kSecond_ns),
                         static_cast<long>(time_ns % kSecond_ns)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
  }

 private:
  static constexpr std::int64_t kSecond_ns = 1'000'000'000;
};

}  // namespace tenon::executor
