// Whole runs in lockstep, on an arm double with walls.

#include "executor/controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "executor/cycle_runner.h"
#include "executor/dry_run/dry_run.h"
#include "shared/base/error.h"
#include "tests/executor/bench.h"

namespace tenon::executor {
namespace {

TEST(Controller, APlanRunsToItsEndByTouch) {
  Bench bench(touch_and_slide_plan());
  bench.arm.walls.push_back({0, +1, 0.13});
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanDone) << bench.ending();
  const PlanRunner& runner = bench.controller.runner();
  ASSERT_EQ(runner.report_count(), 2U);
  EXPECT_EQ(runner.report(0).result.outcome, Outcome::kContact);
  EXPECT_NEAR(runner.report(0).result.travelled[0], 0.03, 5e-4);
  EXPECT_EQ(runner.report(0).result.signature.bits, ContactSignature::bit(0, -1));
  EXPECT_EQ(runner.report(1).result.outcome, Outcome::kReached);
  EXPECT_NEAR(runner.report(1).result.travelled[1], 0.04, 5e-4);
  EXPECT_TRUE(runner.report(1).result.signature.has(0, -1));
  EXPECT_NEAR(bench.arm.wall_force_N().x(), -3.0, 0.5);  // the keep force, held to the end
  EXPECT_EQ(bench.arm.state(), ArmState::kDisabled);
  EXPECT_TRUE(bench.controller.ending().disable_confirmed);
}

TEST(Controller, TheNextMoveStartsInTheCycleAfterTheLastOneEnds) {
  Bench bench(touch_and_slide_plan());
  bench.arm.walls.push_back({0, +1, 0.13});
  bench.run();
  const auto& records = bench.keeper.records;
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (records[i].move_started) starts.push_back(i);
  }
  ASSERT_EQ(starts.size(), 2U);
  const CycleRecord& before = records[starts[1] - 1];
  EXPECT_EQ(before.step, 0);
  EXPECT_EQ(before.phase, GuardedMove::Phase::kDone);
  EXPECT_NEAR(before.setpoint.position_m[0], records[starts[1]].setpoint.position_m[0], 1e-5);
}

TEST(Controller, BiasWeightAndNoiseOfTheSensorDoNotFakeAContact) {
  Plan plan = hand_made_plan();
  plan.steps.push_back(hand_made_step(1, 0.2, {{Outcome::kReached, kSuccessorDone}}));
  Bench bench(plan);
  bench.arm.bias << 8, -12, 5, 0.3, -0.2, 0.1;
  bench.arm.noise_N = 0.1;
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanDone) << bench.ending();
  EXPECT_LT(bench.controller.peak_force_N(), 1.0);
}

TEST(Controller, ATravelOutsideTheEnvelopeFailsThePlanByNamingTheAxis) {
  Plan plan = touch_and_slide_plan();
  plan.steps[0].outcomes[1].envelope.travelled_min[0] = 0.035;
  Bench bench(plan);
  bench.arm.walls.push_back({0, +1, 0.13});
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanFailed);
  EXPECT_EQ(bench.controller.ending().index, 0);
  EXPECT_EQ(bench.controller.ending().transition.deviation, Deviation::kTravelOutside);
  EXPECT_EQ(bench.ending(), "step 0: travelled along x outside what validation saw");
  EXPECT_EQ(bench.controller.runner().report_count(), 1U);
  EXPECT_EQ(bench.arm.state(), ArmState::kDisabled);
}

TEST(Controller, AnOutcomeThatThePlanDoesNotKnowFailsIt) {
  Bench bench(touch_and_slide_plan());  // and no wall
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanFailed);
  EXPECT_EQ(bench.controller.ending().transition.deviation, Deviation::kUnexpectedOutcome);
}

TEST(Controller, AContactThatValidationNeverSawFailsThePlan) {
  Plan plan = touch_and_slide_plan();
  plan.steps[0].outcomes[1].envelope.possible.bits = ContactSignature::bit(0, -1);
  plan.steps[0].outcomes[1].envelope.always.bits = 0;
  Bench bench(plan);
  bench.arm.walls.push_back({1, -1, 2e-4});  // the tool starts 0.2 mm deep: 10 N towards +y, tared
  bench.arm.walls.push_back({0, +1, 0.13});
  bench.run([&] {
    if (bench.controller.state() == State::kRunning) bench.arm.push[1] = -8.0;
  });
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanFailed) << bench.ending();
  EXPECT_EQ(bench.controller.ending().transition.deviation, Deviation::kContactUnforeseen);
  EXPECT_EQ(bench.controller.ending().transition.index, 3);
}

// |-- run --|- stop: jerk -j, (hold), jerk +j -|- hold 0.2 s -|- drives off
TEST(Controller, AStopRequestRampsTheCommandDownWithBoundedJerk) {
  Plan plan = hand_made_plan();
  plan.steps.push_back(hand_made_step(1, 0.3, {{Outcome::kReached, kSuccessorDone}}));
  plan.steps[0].slow_from_m = 0.28;
  const SpeedLimits& limits = plan.parameter_sets[0].speeds;
  for (const int stop_after : {20, 30, 45, 80, 400}) {  // while accelerating, and at speed
    Bench bench(plan);
    bench.run_until(State::kRunning);
    for (int i = 0; i < stop_after; ++i) bench.step();
    bench.controller.request_stop();
    bench.run();
    EXPECT_EQ(bench.controller.ending().reason, EndReason::kStopRequested);
    EXPECT_EQ(bench.arm.state(), ArmState::kDisabled);
    EXPECT_EQ(bench.arm.quick_stops(), 0);

    const auto& records = bench.keeper.records;
    double jerk_max = 0.0;
    double acceleration_max = 0.0;
    double way_m = 0.0;
    for (std::size_t i = 3; i < records.size(); ++i) {
      const auto y = [&](std::size_t back) { return records[i - back].commanded.position_m[1]; };
      constexpr double kT = 2e-3;
      jerk_max = std::max(jerk_max, std::abs(y(0) - 3 * y(1) + 3 * y(2) - y(3)) / (kT * kT * kT));
      acceleration_max = std::max(acceleration_max, std::abs(y(0) - 2 * y(1) + y(2)) / (kT * kT));
      if (records[i].state == State::kStopping) way_m += y(0) - y(1);
    }
    // The admittance rounds the corners of the profile off; its discretisation may add a little.
    EXPECT_LT(jerk_max, 1.5 * limits.jerk_mps3) << stop_after;
    EXPECT_LT(acceleration_max, 1.1 * limits.acceleration_mps2) << stop_after;
    EXPECT_GT(way_m, 1e-4);
    EXPECT_LT(way_m, 0.015);
    bool held = false;
    for (const CycleRecord& r : records) held = held || r.state == State::kHolding;
    EXPECT_TRUE(held);
  }
}

TEST(Controller, AStopRequestInContactDoesNotPressHarder) {
  Bench bench(touch_and_slide_plan());
  bench.arm.walls.push_back({0, +1, 0.13});
  double force_N = 0.0;
  bool touched = false;
  bench.run([&] {
    force_N = std::max(force_N, -bench.arm.wall_force_N().x());
    if (!touched && force_N > 6.0) {
      touched = true;
      bench.controller.request_stop();
    }
  });
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kStopRequested);
  EXPECT_TRUE(touched);
  EXPECT_LT(force_N, 30.0);
  EXPECT_EQ(bench.arm.quick_stops(), 0);
}

TEST(Controller, AForceFaultStopsTheDrivesInTheCycleOfItsSample) {
  Bench bench(touch_and_slide_plan());
  bench.run_until(State::kRunning);
  for (int i = 0; i < 50; ++i) bench.step();
  bench.arm.push[2] = 70.0;
  bench.step();  // measured now, told in the next cycle
  EXPECT_EQ(bench.controller.state(), State::kRunning);
  bench.step();
  EXPECT_EQ(bench.controller.state(), State::kQuickStopping);
  EXPECT_EQ(bench.controller.record().request, ArmRequest::kQuickStop);
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kForceFault);
  EXPECT_NEAR(bench.controller.ending().value, 70.0, 1e-4);
  EXPECT_EQ(bench.ending(), "external force 70 N above force_fault_N = 60");
  EXPECT_EQ(bench.arm.quick_stops(), 1);
  EXPECT_EQ(bench.arm.state(), ArmState::kDisabled);
}

TEST(Controller, AFaultOfTheArmEndsTheRunWithItsReason) {
  Bench bench(touch_and_slide_plan());
  bench.run_until(State::kRunning);
  bench.arm.break_with = {ArmFaultKind::kDriveFault, 2, 0x603F00, 0x8611};
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kArmFault);
  EXPECT_EQ(bench.controller.ending().arm_fault.node, 2);
  EXPECT_EQ(bench.controller.ending().arm_fault.code, 0x8611U);
  EXPECT_FALSE(bench.controller.ending().disable_confirmed);
}

TEST(Controller, ASilentJointIsToleratedForAWhileAndThenAFault) {
  Plan plan = hand_made_plan();
  plan.steps.push_back(hand_made_step(1, 0.2, {{Outcome::kReached, kSuccessorDone}}));
  Bench bench(plan);
  bench.run_until(State::kRunning);
  bench.arm.mute_joints = 0x2;
  for (int i = 0; i < 10; ++i) bench.step();
  EXPECT_EQ(bench.controller.state(), State::kRunning);
  bench.step();
  EXPECT_EQ(bench.controller.state(), State::kQuickStopping);
  bench.arm.mute_joints = 0;
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kFeedbackMissing);
  EXPECT_EQ(bench.ending(), "joint y did not answer for 11 cycles in a row, at most 10");
}

TEST(Controller, ASilentSensorIsAFault) {
  Bench bench(touch_and_slide_plan());
  bench.run_until(State::kRunning);
  bench.run([&] { bench.arm.mute_sensor = true; });
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kWrenchMissing);
}

TEST(Controller, ASaturatedSensorIsAFaultAndNotAZero) {
  Bench bench(touch_and_slide_plan());
  bench.run_until(State::kRunning);
  bench.arm.bias[1] = 260.0;
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kSensorSaturated);
  EXPECT_EQ(bench.controller.ending().index, 1);
}

TEST(Controller, AToolAwayFromTheStartIsRefusedByItsAxis) {
  Bench bench(touch_and_slide_plan(), {}, hand_made_cell(), Vector3(0, 0.03, 0.04));
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kNotAtStart);
  EXPECT_EQ(bench.ending(),
            "the tool's z is at 0.0400 m, the plan's start 's1' has it at 0.0000, must be within "
            "0.002: move it there or use --go-to-start");
  EXPECT_EQ(bench.controller.runner().report_count(), 0U);
}

TEST(Controller, GoToStartBringsTheToolThereAndThePlanRuns) {
  Controller::Parameters parameters;
  parameters.go_to_start = true;
  Bench bench(touch_and_slide_plan(), parameters, hand_made_cell(), Vector3(-0.02, 0.03, 0.04));
  bench.arm.walls.push_back({0, +1, 0.13});
  bench.run_until(State::kRunning);
  EXPECT_LT((bench.arm.tool().position_m - bench.controller.plan().start.position_m).norm(), 1e-4);
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanDone) << bench.ending();
}

TEST(Controller, AContactOnTheWayToTheStartStopsTheRun) {
  Controller::Parameters parameters;
  parameters.go_to_start = true;
  Bench bench(touch_and_slide_plan(), parameters, hand_made_cell(), Vector3(0, 0.10, 0));
  bench.arm.walls.push_back({1, -1, 0.05});
  double force_N = 0.0;
  bench.run([&] { force_N = std::max(force_N, bench.arm.wall_force_N().norm()); });
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kContactOnApproach) << bench.ending();
  EXPECT_EQ(bench.controller.ending().index, 1);
  EXPECT_LT(force_N, 30.0);
  EXPECT_EQ(bench.controller.runner().report_count(), 0U);
}

TEST(Controller, ANoisySensorIsNotTared) {
  Bench bench(touch_and_slide_plan());
  bench.arm.noise_N = 2.0;
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kTareUnsteady) << bench.ending();
  EXPECT_NEAR(bench.controller.ending().value, 2.0, 0.4);
  EXPECT_NEAR(bench.controller.ending().bound, 0.3, 1e-12);
}

TEST(Controller, AMovingArmIsNotTared) {
  Bench bench(touch_and_slide_plan());
  bench.run_until(State::kTaring);
  bench.run([&] { bench.arm.drift_mps = 0.2; });
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kTareMoving) << bench.ending();
}

TEST(Controller, AnArmThatDoesNotEnableIsGivenUp) {
  Bench bench(touch_and_slide_plan());
  bench.arm.never_enables = true;
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kEnableTimeout);
}

TEST(Controller, AnArmThatDoesNotDisableIsSaidSo) {
  Plan plan = hand_made_plan();
  plan.steps.push_back(hand_made_step(1, 0.01, {{Outcome::kReached, kSuccessorDone}}));
  Bench bench(plan);
  bench.arm.never_disables = true;
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanDone);
  EXPECT_FALSE(bench.controller.ending().disable_confirmed);
}

TEST(Controller, AJointAtItsLimitRampsDownInsideItAndIsNamed) {
  Cell cell = hand_made_cell();
  Plan plan = hand_made_plan();
  plan.steps.push_back(hand_made_step(2, 0.4, {{Outcome::kReached, kSuccessorDone}}));
  cell.robot.joints[2].upper = 0.2;
  Bench bench(plan, {}, cell);
  double highest_m = 0.0;
  bench.run(
      [&] { highest_m = std::max(highest_m, bench.controller.record().position_commanded[2]); });
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kJointLimit) << bench.ending();
  EXPECT_EQ(bench.controller.ending().index, 2);
  EXPECT_EQ(bench.controller.ending().bound, 0.2);
  EXPECT_EQ(bench.ending().rfind("step 0: joint z would come to rest at 0.200", 0), 0U)
      << bench.ending();
  EXPECT_EQ(bench.arm.quick_stops(), 0);
  EXPECT_LT(highest_m, 0.2);
  EXPECT_GT(highest_m, 0.199);
}

// late SYNC: the payload's inertia, 8 N for three samples, at the next three cycles
TEST(Controller, TheJoltOfALateSyncIsNoContactCandidateButAForceOfItsOwnIs) {
  for (const bool late : {true, false}) {
    Bench bench(touch_and_slide_plan());
    bench.run_until(State::kRunning);
    for (int i = 0; i < 100; ++i) bench.step();
    bool probed = false;
    for (int i = 0; i < 10; ++i) {
      if (i == 1 && late) bench.controller.report_late_sync();
      bench.arm.push[0] = i < 3 ? -8.0 : 0.0;
      bench.step();
      probed = probed || bench.controller.record().phase == GuardedMove::Phase::kProbing;
    }
    EXPECT_EQ(probed, !late);
  }
}

TEST(Controller, AForceFaultIsSeenThroughALateSync) {
  Bench bench(touch_and_slide_plan());
  bench.run_until(State::kRunning);
  bench.arm.push[0] = -70.0;
  bench.step();
  bench.controller.report_late_sync();
  bench.step();
  EXPECT_EQ(bench.controller.state(), State::kQuickStopping);
}

TEST(Controller, TooManyOverrunsStopTheDrives) {
  Bench bench(touch_and_slide_plan());
  bench.run_until(State::kRunning);
  bench.controller.report_overruns(50);
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kOverruns);
  EXPECT_EQ(bench.arm.quick_stops(), 1);
}

TEST(Controller, AFaultAfterThePlansEndStillMakesTheRunAFault) {
  Plan plan = hand_made_plan();
  plan.steps.push_back(hand_made_step(1, 0.01, {{Outcome::kReached, kSuccessorDone}}));
  Bench bench(plan);
  bench.run_until(State::kHolding);
  bench.arm.push[0] = 80.0;
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kForceFault);
}

// --- six axes -------------------------------------------------------------------------------

Plan arm_plan() {
  Plan plan = touch_and_slide_plan();
  plan.start.position_m = Vector3(0.0, 0.0, 0.05);
  return plan;
}

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

TEST(Controller, APlanWithoutStepsIsRefused) {
  EXPECT_THROW(Controller(hand_made_cell(), hand_made_plan(), {}), InputError);
}

}  // namespace
}  // namespace tenon::executor
