// Brakes after the drives are off: what holds, what slips, and what nobody can see.

#include "executor/sensing/brake_watch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "executor/telemetry/run_result.h"
#include "tests/executor/bench.h"

namespace tenon::executor {
namespace {

constexpr std::uint32_t kEveryJoint = 0b11;
constexpr std::uint32_t kFirst = 0b01;

// A slide and a hinge, 2 ms a cycle.
Robot slide_and_hinge() {
  Robot robot;
  robot.cycle_us = 2000;
  robot.joints.resize(2);
  robot.joints[0].kind = Joint::Kind::kPrismatic;
  robot.joints[1].kind = Joint::Kind::kRevolute;
  return robot;
}

struct Watched {
  BrakeWatch watch{slide_and_hinge(), {}};
  JointVector at{};

  void hold(int cycles, std::uint32_t fresh, std::uint32_t off) {
    for (int i = 0; i < cycles; ++i) watch.update(at, fresh, off);
  }
};

TEST(BrakeWatch, AJointMayMoveByItsPlayAndNoFurther) {
  for (const double way : {0.45e-3, 0.55e-3}) {
    Watched w;
    w.at = {0.3, 1.0};
    w.hold(500, kEveryJoint, 0);
    w.hold(50, kEveryJoint, kEveryJoint);
    EXPECT_FALSE(w.watch.slip());
    w.at[0] -= way;
    w.hold(1, kEveryJoint, kEveryJoint);
    const auto slip = w.watch.slip();
    ASSERT_EQ(slip.has_value(), way > 5e-4) << way;
    if (!slip) continue;
    EXPECT_EQ(slip->joint, 0);
    EXPECT_NEAR(slip->moved, way, 1e-12);
    EXPECT_NEAR(slip->bound, 5e-4, 1e-9);
  }
}

// Not from the last one: they may go off seconds apart.
TEST(BrakeWatch, EachJointCountsFromWhereItsOwnDriveWentOff) {
  Watched w;
  w.hold(500, kEveryJoint, 0);
  w.hold(1, kEveryJoint, kFirst);
  w.at[0] -= 1e-3;  // the other is still on
  w.hold(500, kEveryJoint, kFirst);
  w.hold(1, kEveryJoint, kEveryJoint);
  const auto slip = w.watch.slip();
  ASSERT_TRUE(slip);
  EXPECT_EQ(slip->joint, 0);
}

// 20 mm/s as the power goes; a brake that closes within 0.1 s lets it roll out by less than 2 mm.
TEST(BrakeWatch, WhatMovesAsItsPowerGoesMayRollOut) {
  for (const double way : {1.9e-3, 2.7e-3}) {
    Watched w;
    for (int i = 0; i < 1000; ++i) {
      w.at[0] += 40e-6;
      w.hold(1, kEveryJoint, 0);
    }
    w.hold(1, kEveryJoint, kEveryJoint);
    w.at[0] += way;
    w.hold(1, kEveryJoint, kEveryJoint);
    EXPECT_EQ(w.watch.slip().has_value(), way > 2.5e-3) << way;
  }
}

// 0.4 mm/s are 0.2 mm in half a second.
TEST(BrakeWatch, AJointThatCreepsThroughItsPlayIsWatchedUntilItIsBeyond) {
  for (const double creep_mps : {0.0, 0.05e-3, 0.12e-3, 0.4e-3, -0.4e-3}) {
    Watched w;
    w.hold(500, kEveryJoint, 0);
    int cycles = 0;
    for (; cycles < 2600 && !w.watch.slip(); ++cycles) {
      if (cycles >= 251 && !w.watch.creeps()) break;
      w.at[0] += 0.002 * creep_mps;
      w.hold(1, kEveryJoint, kEveryJoint);
    }
    const bool fails = std::abs(creep_mps) > 0.1e-3;
    EXPECT_EQ(w.watch.slip().has_value(), fails) << creep_mps;
    if (!fails) {
      EXPECT_EQ(cycles, 251) << "nothing more to wait for";
    }
  }
}

TEST(BrakeWatch, AJointThatSettlesInItsBrakeIsNotWatchedForLong) {
  Watched w;
  w.hold(500, kEveryJoint, 0);
  for (int cycle = 0; cycle < 600; ++cycle) {
    w.at[0] = 0.4e-3 * (1.0 - std::exp(-0.002 * cycle / 0.2));
    w.hold(1, kEveryJoint, kEveryJoint);
  }
  EXPECT_FALSE(w.watch.creeps());
  EXPECT_FALSE(w.watch.slip());
}

// Half a second does not tell.
TEST(BrakeWatch, APlanIsNotDoneWhileABrakeCreeps) {
  for (const double watched_s : {kBrakeWatch_s, kBrakeCreep_s}) {
    Plan plan = hand_made_plan();
    plan.steps.push_back(hand_made_step(1, 0.01, {{Outcome::kReached, kSuccessorDone}}));
    Controller::Parameters parameters;
    parameters.brake_creep_s = watched_s;
    Bench bench(plan, parameters);
    bench.run_until(State::kWatching);
    bench.arm.creep_mps = 0.4e-3;
    bench.run();
    EXPECT_EQ(bench.controller.ending().reason,
              watched_s < 1.0 ? EndReason::kPlanDone : EndReason::kBrakeFailed)
        << bench.ending();
  }
}

TEST(BrakeWatch, AJointUnderPowerIsNotJudgedButNotWatchedEither) {
  Watched w;
  w.hold(100, kEveryJoint, 0);
  w.hold(1, kEveryJoint, kEveryJoint);
  EXPECT_EQ(w.watch.unwatched(), 0U);
  w.hold(1, kEveryJoint, kFirst);
  w.at[1] += 1.0;
  w.hold(1, kEveryJoint, kFirst);
  EXPECT_FALSE(w.watch.slip());
  EXPECT_EQ(w.watch.unwatched(), 0b10U);
}

TEST(BrakeWatch, SomeAnswersMayBeLostButNotAllOfThem) {
  Watched w;
  EXPECT_EQ(w.watch.unwatched(), kEveryJoint) << "nobody has ever answered";
  w.hold(100, kEveryJoint, kEveryJoint);
  w.hold(10, kFirst, kEveryJoint);
  EXPECT_EQ(w.watch.unwatched(), 0U);
  w.hold(1, kFirst, kEveryJoint);
  EXPECT_EQ(w.watch.unwatched(), 0b10U);
  w.hold(1, kEveryJoint, kEveryJoint);
  EXPECT_EQ(w.watch.unwatched(), 0U);
}

// All drives are off, and then a node falls silent: the plan is done, but nobody saw its brake.
TEST(BrakeWatch, ADonePlanWhoseBrakesNobodySawIsNoSuccess) {
  for (const std::uint32_t silent : {0U, 0b10U}) {
    Plan plan = hand_made_plan();
    plan.steps.push_back(hand_made_step(1, 0.01, {{Outcome::kReached, kSuccessorDone}}));
    Bench bench(plan);
    bench.run_until(State::kWatching);
    bench.arm.mute_joints = silent;
    bench.run();
    const Ending& ending = bench.controller.ending();
    EXPECT_EQ(ending.reason, silent == 0 ? EndReason::kPlanDone : EndReason::kFeedbackMissing);
    EXPECT_TRUE(ending.disable_confirmed);
    EXPECT_EQ(ending.brakes_unwatched, silent);
    EXPECT_EQ(bench.ending().find("for want of answers") != std::string::npos, silent != 0);
    EXPECT_EQ(bench.keeper.records.back().brakes_unwatched, silent);
    const RunResult result = gather_result(bench.controller, bench.runner, 0, "");
    EXPECT_EQ(result.exit_code, silent == 0 ? 0 : 1);
    EXPECT_EQ(result.ended_badly(), silent != 0);
  }
}

}  // namespace
}  // namespace tenon::executor
