#include "executor/sensing/following_watch.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/hand_made.h"

namespace tenon::executor {
namespace {

constexpr std::uint32_t kAll = 7;

Robot robot() {
  Robot robot = hand_made_cell().robot;
  for (Joint& joint : robot.joints) joint.following_error_max = 0.005;
  robot.cycle_us = 2000;
  robot.response_lag_s = 0.004;
  return robot;
}

// Joint 1 at 0.5 m/s; the arm is `late` cycles behind. @return the cycle in which it is named, or
// -1
int named_in(FollowingWatch& watch, int late) {
  constexpr double kPerCycle = 0.001;
  watch.rest_at({});
  for (int cycle = 0; cycle < 200; ++cycle) {
    JointVector measured{};
    measured[1] = kPerCycle * std::max(0, cycle - late);
    if (watch.update(measured, kAll)) return cycle;
    JointVector command{};
    command[1] = kPerCycle * cycle;
    watch.commanded(command);
  }
  return -1;
}

TEST(FollowingWatch, AnArmBehindByItsLagFollows) {
  FollowingWatch watch(robot());
  EXPECT_EQ(named_in(watch, 2), -1);
  EXPECT_EQ(named_in(watch, 10), -1) << "the window's length: three lags and four commands";
}

TEST(FollowingWatch, OneFurtherBehindThanItsFollowingErrorIsNamed) {
  FollowingWatch watch(robot());
  const int cycle = named_in(watch, 1000);
  // 5 mm behind the oldest of ten commands after some 15 cycles, for longer than 20 ms.
  EXPECT_GT(cycle, 15 + 10);
  EXPECT_LT(cycle, 15 + 10 + 5);
}

TEST(FollowingWatch, AtRestAJointThatIsPushedAwayIsNamedAfterTwentyMilliseconds) {
  FollowingWatch watch(robot());
  watch.rest_at({});
  JointVector pushed{};
  pushed[2] = -0.006;
  int cycles = 0;
  while (!watch.update(pushed, kAll) && cycles < 100) {
    watch.commanded({});
    ++cycles;
  }
  EXPECT_EQ(cycles, watch.cycles_max());
  const auto excess = watch.update(pushed, kAll);
  ASSERT_TRUE(excess);
  EXPECT_EQ(excess->joint, 2);
  EXPECT_NEAR(excess->error, 0.006, 1e-12);
  EXPECT_EQ(excess->bound, 0.005);
}

// Before it is too far off itself, it may have led the tool into something.
TEST(FollowingWatch, BeyondAQuarterOfItsBoundAJointLags) {
  FollowingWatch watch(robot());
  watch.rest_at({});
  JointVector measured{};
  measured[0] = 0.001;
  EXPECT_FALSE(watch.update(measured, kAll));
  EXPECT_FALSE(watch.laggard());
  measured[1] = -0.003;
  measured[2] = 0.004;
  EXPECT_FALSE(watch.update(measured, kAll));
  ASSERT_TRUE(watch.laggard());
  EXPECT_EQ(watch.laggard()->joint, 2);
  EXPECT_NEAR(watch.laggard()->error, 0.004, 1e-12);
  EXPECT_FALSE(watch.update({}, kAll));
  EXPECT_TRUE(watch.laggard()) << "it has just come back";
  for (int cycle = 0; cycle < 60; ++cycle) EXPECT_FALSE(watch.update({}, kAll));
  EXPECT_FALSE(watch.laggard());
  EXPECT_FALSE(watch.update(measured, kAll));
  watch.rest_at(measured);
  EXPECT_FALSE(watch.laggard()) << "it is where it should be";
}

TEST(FollowingWatch, AJointThatDoesNotAnswerIsNotJudged) {
  FollowingWatch watch(robot());
  watch.rest_at({});
  JointVector old{};
  old[0] = 1.0;
  for (int cycle = 0; cycle < 100; ++cycle) {
    EXPECT_FALSE(watch.update(old, kAll & ~1U));
    watch.commanded({});
  }
}

}  // namespace
}  // namespace tenon::executor
