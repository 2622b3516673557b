// When tenon-sim --once ends.

#include "sim/cell/virtual_arm/one_client.h"

#include <gtest/gtest.h>

namespace tenon::sim {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;

// Wakes every millisecond. @return at which one it had finished, or -1
int first_end(OneClient& client, std::int64_t& now_ns, int wakes) {
  for (int i = 0; i < wakes; ++i) {
    if (client.finished(false, true, now_ns += kMillisecond_ns)) return i;
  }
  return -1;
}

TEST(OneClient, EndsASecondAfterItHasGone) {
  OneClient client;
  std::int64_t now_ns = 0;
  EXPECT_EQ(first_end(client, now_ns, 3000), -1);  // nobody came
  EXPECT_FALSE(client.finished(true, true, now_ns += kMillisecond_ns));
  EXPECT_FALSE(client.finished(false, false, now_ns += kMillisecond_ns));
  EXPECT_EQ(first_end(client, now_ns, 3000), 1000);
}

// client:  ---there---| gone
// process: -----------|  stalled for 3 s  |--1 s--| end: brakes are on by then
TEST(OneClient, AStallIsNoRest) {
  OneClient client;
  std::int64_t now_ns = 0;
  EXPECT_FALSE(client.finished(true, true, now_ns += kMillisecond_ns));
  EXPECT_FALSE(client.finished(false, true, now_ns += 3'000 * kMillisecond_ns));
  EXPECT_GT(first_end(client, now_ns, 3000), 900);
}

}  // namespace
}  // namespace tenon::sim
