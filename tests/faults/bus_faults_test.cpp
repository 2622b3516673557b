// Faults of the bus in the middle of a run, in lockstep: the executor rides them out or ends with a
// reason that says what happened. It never hangs, and what it calls done is at the goal.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/faulty_options.h"
#include "tests/support/frame_filter.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;

/// A run that ends by itself, and is right where it says that it is done.
class FaultyRun {
 public:
  explicit FaultyRun(const std::vector<std::string>& specs)
      : lockstep(gantry_cell(), box_task(), box_plan("1"), with_faults(specs)),
        result(lockstep.run()) {
    EXPECT_LT(result.cycles, 100'000) << "it hangs";
    EXPECT_FALSE(result.reason.empty());
    EXPECT_NE(result.ending.reason, EndReason::kNone) << result.reason;
    if (result.ending.reason == EndReason::kPlanDone) {
      EXPECT_LT(result.truth.error_norm_m, box_task().goal_tolerance_m) << "done, but wrong";
    }
    for (const auto& drive : result.truth.drives) {
      const bool held = drive.brake_engaged || result.ending.reason == EndReason::kArmFault;
      EXPECT_TRUE(held) << drive.joint << " is left without a brake";
    }
  }

  WholeRun lockstep;
  WholeRun::Result result;
};

TEST(BusFaults, SingleFramesLateRepeatedAndShortOnesAndAMissedCycleAreRiddenOut) {
  for (const char* spec :
       {"drop:node=1,time_s=4", "drop:node=4,time_s=4", "drop:node=127,time_s=4,id=sync",
        "duplicate:node=2,time_s=2,duration_s=100,probability=0.2",
        "corrupt-length:node=3,time_s=4", "delay:node=2,time_s=4,duration_s=0.006,delay_s=0.0012",
        "queue-full:node=127,time_s=4,duration_s=0.003"}) {
    FaultyRun run({spec});
    EXPECT_EQ(run.result.ending.reason, EndReason::kPlanDone) << spec << ": " << run.result.reason;
    // Each left its mark, so it did happen.
    const auto& counters = run.lockstep.arm().counters();
    const std::string kind = std::string(spec).substr(0, std::string(spec).find(':'));
    if (kind == "drop") {
      EXPECT_EQ(run.lockstep.statistics().incomplete_cycles, 1) << spec;
    } else if (kind == "corrupt-length") {
      EXPECT_EQ(counters.malformed_frames, 1U);
    } else if (kind == "delay") {
      EXPECT_GT(counters.late_frames, 0U);
    } else if (kind == "queue-full") {
      EXPECT_GT(counters.send_failures, 0U);
    }
  }
}

TEST(BusFaults, WhatLastsEndsTheRunByName) {
  struct Case {
    const char* spec;
    ArmFaultKind kind;
    int node;
  };
  for (const Case& wanted : {
           Case{"drop:node=1,time_s=4,duration_s=100", ArmFaultKind::kFeedbackMissing, 1},
           Case{"drop:node=4,time_s=4,duration_s=100", ArmFaultKind::kSensorStale, 4},
           // Always after the deadline.
           Case{"delay:node=2,time_s=4,duration_s=100,delay_s=0.0012",
                ArmFaultKind::kFeedbackMissing, 2},
           Case{"corrupt-length:node=3,time_s=4,duration_s=100", ArmFaultKind::kFeedbackMissing, 3},
           Case{"bus-off:node=127,time_s=4", ArmFaultKind::kBusOff, 0},
           Case{"bus-off:node=2,time_s=4", ArmFaultKind::kFeedbackMissing, 2},
           // It comes back, and is a fault all the same.
           Case{"interface-down:time_s=4,duration_s=0.01", ArmFaultKind::kBusDown, 0},
           // Over before its effect could pass for a contact or a force.
           Case{"queue-full:node=127,time_s=4,duration_s=0.006", ArmFaultKind::kQueueFull, 0},
           Case{"queue-full:node=127,time_s=4", ArmFaultKind::kQueueFull, 0},
           Case{"drop:time_s=4,duration_s=0.008", ArmFaultKind::kBusSilent, 0},
           // Never three cycles in a row, and never all of them.
           Case{"queue-full:node=1,id=rpdo,time_s=4,probability=0.3", ArmFaultKind::kSetpointUnsent,
                1},
       }) {
    const FaultyRun run({wanted.spec});
    EXPECT_EQ(run.result.ending.reason, EndReason::kArmFault) << wanted.spec;
    EXPECT_EQ(run.result.ending.arm_fault.kind, wanted.kind) << run.result.reason;
    EXPECT_EQ(run.result.ending.arm_fault.node, wanted.node) << run.result.reason;
  }
}

// Each cycle brings a wrench, but one from five cycles ago, and later from eight: a contact would
// be felt that much too late.
TEST(BusFaults, ASensorWhoseAnswersAreLateByWholeCyclesIsNamed) {
  const std::string late = "delay:node=4,id=answers,duration_s=100,";
  for (const std::vector<std::string>& specs : {
           std::vector<std::string>{late + "time_s=4,delay_s=0.010",
                                    late + "time_s=4.5,delay_s=0.006"},
           {late + "time_s=4,delay_s=0.006"},
       }) {
    const FaultyRun run(specs);
    EXPECT_EQ(run.result.ending.arm_fault.kind, ArmFaultKind::kSensorStale) << run.result.reason;
    EXPECT_NE(run.result.reason.find("node 4 (force/torque sensor): its samples are "),
              std::string::npos)
        << run.result.reason;
  }
}

// The other five go on: a touch along x is then felt by no threshold and no limit.
TEST(BusFaults, AForceThatStandsStillOnOneAxisIsNamed) {
  WholeRun run(gantry_cell(), box_task(), box_plan("1"), with_faults({}));
  ASSERT_TRUE(run.prepare());
  constexpr std::int64_t kDies_ns = 2'500'000'000;
  std::optional<std::array<std::uint8_t, 2>> last;
  const FrameFilter filter(run.bus(), [&](CanFrame& frame, std::size_t) {
    if (frame.id != 0x181 || run.now_ns() < kDies_ns) return true;
    if (!last) last = {frame.data[0], frame.data[1]};
    frame.data[0] = (*last)[0];
    frame.data[1] = (*last)[1];
    return true;
  });
  while (run.cycle()) ASSERT_LT(run.now_ns(), 40 * kDies_ns);
  const auto result = run.result();
  EXPECT_EQ(result.ending.reason, EndReason::kWrenchFrozen) << result.reason;
  EXPECT_NE(result.reason.find("the sensor's axis x has not changed"), std::string::npos)
      << result.reason;
  EXPECT_LT(result.truth.contact_force_N_max, gantry_cell().force_fault_N);
}

// At any length of the cycle the arm, which knows the node, is heard before the executor's own
// bound.
TEST(BusFaults, ADeadSensorIsNamedByItsNodeAtAnyCycle) {
  for (const std::uint32_t cycle_us : {2000U, 5000U, 10000U}) {
    Cell cell = gantry_cell();
    cell.robot.cycle_us = cycle_us;
    cell.robot.response_lag_s = 2e-6 * cycle_us;
    const auto result =
        WholeRun(cell, box_task(), box_plan("1"), with_faults({"stale-force:node=4,time_s=4"}))
            .run();
    EXPECT_EQ(result.ending.reason, EndReason::kArmFault) << cycle_us << " us: " << result.reason;
    EXPECT_EQ(result.ending.arm_fault.kind, ArmFaultKind::kSensorStale) << result.reason;
    EXPECT_NE(result.reason.find("node 4 (force/torque sensor)"), std::string::npos)
        << result.reason;
  }
}

TEST(BusFaults, TheSameSeedStrikesTheSameFramesWhoeverElseDraws) {
  const std::string spec = "drop:time_s=3,duration_s=100,probability=0.001,seed=";
  const std::string other_draws = "duplicate:id=0x7E5,time_s=3,duration_s=100,probability=0.5";
  FaultyRun once({spec + "8"});
  FaultyRun again({spec + "8", other_draws});
  FaultyRun other({spec + "9"});
  EXPECT_EQ(once.result.truth.tool, again.result.truth.tool);
  const auto missing = [](FaultyRun& run) {
    return run.lockstep.arm().counters().joint_frames_missing;
  };
  EXPECT_GT(missing(once), 0U);
  EXPECT_EQ(missing(once), missing(again));
  EXPECT_NE(once.result.truth.tool, other.result.truth.tool);
  const FaultyRun hopeless({"drop:time_s=3,duration_s=100,probability=0.4,seed=3"});
  EXPECT_NE(hopeless.result.ending.reason, EndReason::kPlanDone);
}

TEST(BusFaults, ABusThatGoesOnLosingFramesEndsTheRunByName) {
  // Every cycle without its feedback takes a little of the plan's accuracy, unseen by its
  // envelopes.
  const std::string spec = "drop:time_s=3,duration_s=100,probability=0.005,seed=";
  for (const char* seed : {"8", "9"}) {
    const FaultyRun run({spec + seed});
    EXPECT_EQ(run.result.ending.reason, EndReason::kFeedbackPoor) << run.result.reason;
  }
}

TEST(BusFaults, FaultsWhileTheArmIsBroughtUpEndByNameToo) {
  for (const char* spec : {"drop:node=2,duration_s=100", "interface-down:time_s=0.2",
                           "bus-off:node=127,time_s=0.2", "queue-full:node=127,time_s=0.1"}) {
    WholeRun run(gantry_cell(), box_task(), box_plan("1"), with_faults({spec}));
    EXPECT_FALSE(run.prepare()) << spec;
    EXPECT_NE(run.arm().fault().kind, ArmFaultKind::kNone) << spec;
  }
}

TEST(BusFaults, ANoisyWireCostsErrorFramesAndNoSetpoint) {
  WholeRun::Options options = with_faults({});
  options.bit_error_rate = 1e-5;
  WholeRun run(gantry_cell(), box_task(), box_plan("1"), options);
  const auto result = run.run();
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
  EXPECT_GT(run.bus().statistics().error_frames, 10U);
  EXPECT_EQ(run.statistics().missed_cycles, 0);
  EXPECT_EQ(run.statistics().incomplete_cycles, 0);
}

}  // namespace
}  // namespace tenon::tests
