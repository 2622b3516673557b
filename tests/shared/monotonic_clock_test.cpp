// The clock and the wait on it, without a word on how long anything takes.

#include "shared/system/monotonic_clock.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace tenon {
namespace {

TEST(MonotonicClock, NeverStepsBackAndAWaitEndsNoSoonerThanAsked) {
  const std::int64_t before_ns = monotonic_now_ns();
  wait_until_ns(before_ns + 2'000'000);
  const std::int64_t after_ns = monotonic_now_ns();
  EXPECT_GE(after_ns, before_ns + 2'000'000);
  wait_until_ns(before_ns);  // has passed
  EXPECT_GE(monotonic_now_ns(), after_ns);
}

}  // namespace
}  // namespace tenon
