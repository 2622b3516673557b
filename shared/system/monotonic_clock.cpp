#include "shared/system/monotonic_clock.h"

#include <errno.h>
#include <time.h>

namespace tenon {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

std::int64_t now_ns(clockid_t clock) noexcept {
  timespec now{};
  ::clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * kSecond_ns + now.tv_nsec;
}

}  // namespace

std::int64_t monotonic_now_ns() noexcept { return now_ns(CLOCK_MONOTONIC); }

void wait_until_ns(std::int64_t monotonic_ns) noexcept {
  const timespec until{static_cast<time_t>(monotonic_ns / kSecond_ns),
                       static_cast<long>(monotonic_ns % kSecond_ns)};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

std::int64_t wall_clock_us() noexcept { return now_ns(CLOCK_REALTIME) / 1000; }

std::int64_t monotonic_of_realtime_ns(std::int64_t realtime_ns) noexcept {
  return realtime_ns + (monotonic_now_ns() - now_ns(CLOCK_REALTIME));
}

}  // namespace tenon
