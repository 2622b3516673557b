// Whole runs in lockstep, on an arm double with walls.

#include "executor/loop/controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "executor/loop/cycle_runner.h"
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
  EXPECT_EQ(bench.ending(), "step 0: travelled 30.07 mm along x where validation saw 35 to 52");
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

// Voltage off in mid-ramp would drop the axis onto its brake.
TEST(Controller, TheDrivesHaveTheTimeThatTheirDecelerationTakes) {
  Cell cell = hand_made_cell();
  for (Joint& joint : cell.robot.joints) joint.acceleration_max = joint.speed_max / 1.5;
  Bench bench(touch_and_slide_plan(), {}, cell);
  bench.run_until(State::kRunning);
  bench.arm.drift_mps = 0.05;
  bench.arm.push[2] = 70.0;
  bench.run_until(State::kQuickStopping);
  const auto cycles_of = [](double time_s) { return static_cast<int>(1e9 * time_s / kCycle_ns); };
  for (int i = 0; i < cycles_of(1.5); ++i) bench.step();
  EXPECT_EQ(bench.controller.state(), State::kQuickStopping);
  for (int i = 0; i < cycles_of(0.2); ++i) bench.step();
  EXPECT_GT(bench.controller.state(), State::kQuickStopping);
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

TEST(Controller, ASensorThatComesToRestIsTared) {
  Bench bench(touch_and_slide_plan());
  bench.arm.walls.push_back({0, +1, 0.13});
  bench.arm.noise_N = 2.0;
  int cycles = 0;
  bench.run([&] {
    if (++cycles == 500) bench.arm.noise_N = 0.0;
  });
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanDone) << bench.ending();
}

// The sensor reads steadily; only what the cell knows of it tells that something pushes.
TEST(Controller, TaringAgainstSomethingThatPushesIsRefusedWhereTheCellKnowsTheBias) {
  Cell cell = hand_made_cell();
  cell.sensor_bias = SensorBias{Vector6::Zero(), 3.0, 0.5};
  cell.sensor_bias->wrench << 4.0, -2.0, 1.0, 0.1, 0.0, -0.2;
  Bench good(touch_and_slide_plan(), {}, cell);
  good.arm.bias = cell.sensor_bias->wrench;
  good.arm.walls.push_back({0, +1, 0.13});
  good.run();
  EXPECT_EQ(good.controller.ending().reason, EndReason::kPlanDone) << good.ending();

  Bench pushed(touch_and_slide_plan(), {}, cell);
  pushed.arm.bias = cell.sensor_bias->wrench;
  pushed.arm.push[2] = 8.0;
  pushed.run();
  EXPECT_EQ(pushed.controller.ending().reason, EndReason::kTareOffset) << pushed.ending();
  EXPECT_NE(pushed.ending().find("sensor_bias"), std::string::npos) << pushed.ending();
  EXPECT_EQ(pushed.controller.runner().report_count(), 0U);
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
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kNotDisabled);
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
      if (i == 1 && late) bench.controller.distrust_samples();
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
  bench.controller.distrust_samples();
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

TEST(Controller, APlanWithoutStepsIsRefused) {
  EXPECT_THROW(Controller(hand_made_cell(), hand_made_plan(), {}), InputError);
}

}  // namespace
}  // namespace tenon::executor
