// A move that the user pauses: it comes to rest by its own speed, and goes on as if nothing had
// been.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "executor/loop/controller.h"
#include "executor/telemetry/trace.h"
#include "tests/executor/bench.h"
#include "tests/support/scratch_folder.h"

namespace tenon::executor {
namespace {

constexpr double kPausedCycle_s = 2e-3;

Plan long_way() {
  Plan plan = hand_made_plan();
  plan.steps.push_back(hand_made_step(1, 0.2, {{Outcome::kReached, kSuccessorDone}}));
  plan.goal.position_m.y() += 0.2;
  return plan;
}

void run_cycles(Bench& bench, int cycles) {
  for (int i = 0; i < cycles; ++i) ASSERT_TRUE(bench.step()) << bench.ending();
}

double speed_mps(const CycleRecord& record) { return vector_of(record.velocity).head<3>().norm(); }

// 6,000 cycles are 12 s, longer than the step's time limit.
TEST(Pause, AMoveComesToRestOnItsWayAndGoesOn) {
  Bench whole(long_way());
  whole.run();
  Bench bench(long_way());
  bench.run_until(State::kRunning);
  run_cycles(bench, 500);
  ASSERT_GT(speed_mps(bench.controller.record()), 0.02);
  bench.controller.pause(true);
  run_cycles(bench, 3000);
  EXPECT_EQ(bench.controller.record().pace, 0.0);
  const Pose rests = bench.arm.tool();
  run_cycles(bench, 6000);
  EXPECT_LT(displacement_between(rests, bench.arm.tool()).norm(), 1e-6);
  EXPECT_LT((rests.position_m - long_way().start.position_m).cwiseAbs().x(), 1e-6) << "off its way";
  bench.controller.pause(false);
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanDone) << bench.ending();
  EXPECT_LT(displacement_between(whole.arm.tool(), bench.arm.tool()).norm(), 1e-5);
  const auto took_s = [](const Bench& of) {
    return 1e-9 * static_cast<double>(of.controller.runner().report(0).result.duration_ns);
  };
  EXPECT_NEAR(took_s(bench), took_s(whole), 0.05) << "a paused move's time stands";
}

// Of the setpoint: its path by the clock.
TEST(Pause, AccelerationStaysWithinHalfAsMuchAgain) {
  Bench bench(long_way());
  bench.run_until(State::kRunning);
  for (int i = 0; i < 40; ++i) {
    bench.controller.pause(i % 2 == 0);
    run_cycles(bench, i < 20 ? 37 : 150);
  }
  const SpeedLimits limits = long_way().parameter_sets[0].speeds;
  std::vector<double> path_m;
  for (const CycleRecord& record : bench.keeper.records) {
    if (record.moving) path_m.push_back(pose_of(record.setpoint).position_m.y());
  }
  ASSERT_GT(path_m.size(), 3000U);
  double most_mps = 0.0;
  double most_mps2 = 0.0;
  for (std::size_t i = 2; i < path_m.size(); ++i) {
    const double speed = (path_m[i] - path_m[i - 1]) / kPausedCycle_s;
    const double before = (path_m[i - 1] - path_m[i - 2]) / kPausedCycle_s;
    most_mps = std::max(most_mps, std::abs(speed));
    most_mps2 = std::max(most_mps2, std::abs(speed - before) / kPausedCycle_s);
  }
  EXPECT_LE(most_mps, 1.001 * limits.approach_mps);
  EXPECT_LE(most_mps2, 1.55 * limits.acceleration_mps2);
}

TEST(Pause, WhatPausesIsWatchedAndStopsWhenAsked) {
  for (const bool pushed : {true, false}) {
    Bench bench(long_way());
    bench.run_until(State::kRunning);
    run_cycles(bench, 300);
    bench.controller.pause(true);
    run_cycles(bench, 400);
    if (pushed) bench.arm.push[1] = -80.0;
    if (!pushed) bench.controller.request_stop();
    bench.run();
    EXPECT_EQ(bench.controller.ending().reason,
              pushed ? EndReason::kForceFault : EndReason::kStopRequested)
        << bench.ending();
  }
}

// Wherever the pause comes, a wall is met no harder than without one, and stays a contact.
TEST(Pause, ATouchOnTheWayToRestIsMetNoHarder) {
  double whole_N = 0.0;
  for (const int at : {-1, 150, 250, 280, 300, 320, 340}) {
    Bench bench(touch_and_slide_plan());
    bench.arm.walls.push_back({0, +1, 0.13});
    bench.run_until(State::kRunning);
    double most_N = 0.0;
    int cycle = 0;
    bench.run([&] {
      if (cycle == at) bench.controller.pause(true);
      if (cycle == at + 1000) bench.controller.pause(false);
      ++cycle;
      most_N = std::max(most_N, bench.arm.wall_force_N().norm());
    });
    EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanDone) << at << bench.ending();
    EXPECT_EQ(bench.controller.runner().report(0).result.outcome, Outcome::kContact) << at;
    if (at < 0) whole_N = most_N;
    EXPECT_LE(most_N, 1.05 * whole_N) << at;
  }
}

TEST(Pause, ATraceOfAPausedMoveReplaysBitForBit) {
  const tests::ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "trace.txt";
  {
    Bench bench(touch_and_slide_plan());
    bench.arm.walls.push_back({0, +1, 0.13});
    bench.run_until(State::kRunning);
    int cycle = 0;
    bench.run([&] {
      bench.controller.pause(cycle % 500 > 250);
      ++cycle;
    });
    ASSERT_EQ(bench.controller.ending().reason, EndReason::kPlanDone) << bench.ending();
    TraceWriter writer(file, bench.controller.runner());
    for (const CycleRecord& record : bench.keeper.records) writer.consume(record);
  }
  const Plan plan = touch_and_slide_plan();
  const std::vector<TracedMove> moves = read_trace(file);
  ASSERT_EQ(moves.size(), 2U);
  for (const TracedMove& traced : moves) {
    GuardedMove move(move_parameters(plan, traced), traced.signature_before, traced.held);
    for (const TracedInput& input : traced.inputs) {
      ASSERT_EQ(move.update(input.input).setpoint.pose, input.setpoint);
    }
    ASSERT_TRUE(move.result());
    EXPECT_EQ(move.result()->outcome, traced.outcome);
    EXPECT_EQ(move.result()->duration_ns, traced.duration_ns);
  }
}

}  // namespace
}  // namespace tenon::executor
