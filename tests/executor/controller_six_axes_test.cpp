// The controller of an arm with six axes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "executor/dry_run/dry_run.h"
#include "executor/loop/controller.h"
#include "tests/executor/bench.h"

namespace tenon::executor {
namespace {

JointVector arm_start() { return *dry_run(arm_plan(), hand_made_arm_cell()).start; }

Controller::Parameters go_to_start() {
  Controller::Parameters parameters;
  parameters.go_to_start = true;
  return parameters;
}

TEST(ControllerOnSixAxes, APlanRunsToItsEndByTouch) {
  Bench bench(arm_plan(), {}, hand_made_arm_cell(), arm_start());
  bench.arm.walls.push_back({0, +1, 0.03});
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanDone) << bench.ending();
  EXPECT_NEAR(bench.arm.tool().position_m.x(), 0.03, 5e-4);
  EXPECT_NEAR(bench.arm.tool().position_m.y(), 0.04, 5e-4);
  EXPECT_LT(rotation_vector(bench.arm.tool().orientation).norm(), 1e-6);
}

TEST(ControllerOnSixAxes, GoToStartMovesAllJointsTogetherAndThePlanRuns) {
  JointVector joints = arm_start();
  for (std::size_t i = 0; i < 6; ++i) joints[i] += i % 2 == 0 ? 0.3 : -0.25;
  Bench bench(arm_plan(), go_to_start(), hand_made_arm_cell(), joints);
  bench.arm.walls.push_back({0, +1, 0.03});
  bench.run_until(State::kRunning);
  EXPECT_LT(displacement_between(bench.arm.tool(), arm_plan().start).norm(), 1e-6);
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanDone) << bench.ending();
}

// The wrist turned over holds the same tool pose: q4 + pi, -q5, q6 - pi, and a little more for the
// forearm's offset.
TEST(ControllerOnSixAxes, TheSameToolPoseOnAnotherBranchIsNotTheStart) {
  const Cell cell = hand_made_arm_cell();
  const DryRun run = dry_run(arm_plan(), cell);
  JointVector turned = *run.start;
  turned[3] += turned[3] > 0.0 ? -3.14 : 3.14;
  turned[4] = -turned[4];
  turned[5] += turned[5] > 0.0 ? -3.14 : 3.14;
  SerialChain::InverseParameters parameters;
  parameters.respect_limits = false;
  const SerialChain chain(cell.robot);
  const JointVector joints = chain.inverse(chain.flange(*run.start), turned, parameters).position;
  ASSERT_GT(std::abs(joints[4] - (*run.start)[4]), 1.0);
  WallArm arm(cell, joints);
  ASSERT_LT(displacement_between(arm.tool(), arm_plan().start).norm(), 1e-6);
  Controller controller(cell, run, {});
  CycleRunner runner(arm, controller, nullptr, {});
  (void)arm.prepare(0);
  for (std::int64_t now_ns = 0; runner.step(now_ns); now_ns += kCycle_ns) {
  }
  EXPECT_EQ(controller.ending().reason, EndReason::kOtherBranch)
      << to_string(controller.ending().reason);
  const std::string line = describe(controller.ending(), controller.plan(), cell);
  EXPECT_EQ(line.rfind("joint arm_", 0), 0U) << line;
  EXPECT_NE(line.find("--go-to-start"), std::string::npos) << line;
}

TEST(ControllerOnSixAxes, AContactOnTheWayToTheStartStopsTheJointsAtOnce) {
  JointVector joints = arm_start();
  joints[0] += 0.4;
  Bench bench(arm_plan(), go_to_start(), hand_made_arm_cell(), joints);
  const double wall_m = bench.arm.tool().position_m.y() - 0.05;
  bench.arm.walls.push_back({1, -1, wall_m});
  double force_N = 0.0;
  bench.run([&] { force_N = std::max(force_N, bench.arm.wall_force_N().norm()); });
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kContactOnApproach) << bench.ending();
  EXPECT_EQ(bench.controller.ending().index, 1);
  // F_on, and the way of four cycles at contact speed into 5e4 N/m.
  EXPECT_LT(force_N, 6.0 + 5e4 * 0.05 * 4 * 2e-3);
  EXPECT_EQ(bench.arm.quick_stops(), 0);
}

TEST(ControllerOnSixAxes, AToolThatLeavesTheReachRampsTheJointsDownByStepAndNumber) {
  Plan plan = arm_plan();
  plan.steps.assign(1, hand_made_step(0, 0.6, {{Outcome::kReached, kSuccessorDone}}));
  Bench bench(plan, {}, hand_made_arm_cell(), arm_start());
  bench.run();
  EXPECT_EQ(end_manner(bench.controller.ending().reason), EndManner::kJointRamp) << bench.ending();
  EXPECT_EQ(bench.ending().rfind("step 0: ", 0), 0U) << bench.ending();
  EXPECT_EQ(bench.arm.quick_stops(), 0);
  const auto& records = bench.keeper.records;
  double fastest = 0.0;
  int stopping = 0;
  for (std::size_t i = 2; i < records.size(); ++i) {
    for (std::size_t joint = 0; joint < 6; ++joint) {
      const auto q = [&](std::size_t back) { return records[i - back].position_commanded[joint]; };
      fastest = std::max(fastest, std::abs(q(0) - q(1)) / 2e-3);
      if (records[i].state != State::kStopping || records[i - 1].state != State::kStopping)
        continue;
      ++stopping;
      EXPECT_LT(std::abs(q(0) - 2.0 * q(1) + q(2)) / 4e-6, 5.0 * 1.01);
    }
  }
  EXPECT_LT(fastest, 1.26 * 1.001);
  EXPECT_GT(stopping, 6);
}

}  // namespace
}  // namespace tenon::executor
