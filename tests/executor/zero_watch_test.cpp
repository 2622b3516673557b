// The sensor's zero at a plan's end: what the tool brushes falls off, a zero that has moved stays.

#include "executor/sensing/zero_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/executor/bench.h"

namespace tenon::executor {
namespace {

constexpr double kBound = 0.75;

ZeroWatch::Status after_a_push(double force_N, double time_constant_s) {
  ZeroWatch watch({.samples = 100});
  for (int sample = 0; sample < 2000; ++sample) {
    const double falls = std::exp(-2e-3 * sample / time_constant_s);
    (void)watch.add(Vector6::Unit(2) * force_N * falls);
  }
  return watch.status();
}

TEST(ZeroWatch, APushThatFallsOffIsNoneAndOneThatStaysIsNamed) {
  EXPECT_EQ(after_a_push(0.0, 1.0), ZeroWatch::Status::kZero);
  for (const double soft_s : {0.03, 0.3, 0.6}) {
    EXPECT_EQ(after_a_push(6.0, soft_s), ZeroWatch::Status::kZero) << soft_s;
  }
  EXPECT_EQ(after_a_push(0.9 * kBound, 1e9), ZeroWatch::Status::kZero);
  EXPECT_EQ(after_a_push(1.1 * kBound, 1e9), ZeroWatch::Status::kMoved);
  EXPECT_EQ(after_a_push(-3.0, 1e9), ZeroWatch::Status::kMoved);
}

TEST(ZeroWatch, AnAxisOnWhichTheToolDoesNotYieldSaysNothing) {
  ZeroWatch watch({.samples = 10, .axes = 0x03});
  for (int sample = 0; sample < 10; ++sample) (void)watch.add(Vector6::Unit(2) * 5.0);
  EXPECT_EQ(watch.status(), ZeroWatch::Status::kZero);
}

Plan way_in_free_air() {
  Plan plan = hand_made_plan();
  plan.steps.push_back(hand_made_step(0, 0.03, {{Outcome::kReached, kSuccessorDone}}));
  plan.goal.position_m.x() += 0.03;
  return plan;
}

TEST(ZeroWatch, APlanInFreeAirIsDoneUnlessItsZeroHasMoved) {
  for (const double shift_N : {0.0, 0.5, 2.0}) {
    Bench bench(way_in_free_air());
    bench.arm.noise_N = 0.1;
    bench.run_until(State::kRunning);
    bench.arm.bias[1] += shift_N;
    bench.run();
    const bool moved = shift_N > kBound;
    EXPECT_EQ(bench.controller.ending().reason,
              moved ? EndReason::kZeroMoved : EndReason::kPlanDone)
        << bench.ending();
    EXPECT_TRUE(bench.controller.ending().disable_confirmed);
  }
}

// 2.5 N against something soft, less than a contact: the tool yields to it.
TEST(ZeroWatch, WhatTheToolBrushesAtItsEndIsNoMovedZero) {
  Bench bench(way_in_free_air());
  bench.arm.stiffness_Npm = 5e3;
  bench.arm.walls.push_back({0, +1, 0.1295});
  double most_N = 0.0;
  bench.run([&] { most_N = std::max(most_N, bench.arm.wall_force_N().norm()); });
  EXPECT_GT(most_N, kBound);
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanDone) << bench.ending();
}

}  // namespace
}  // namespace tenon::executor
