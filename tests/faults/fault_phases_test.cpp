// Faults that wait for what the cell does: in whole runs the phases come in their order, each at
// its place, and a fault strikes there.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "sim/cell/faults/fault_spec.h"
#include "tests/support/faulty_options.h"
#include "tests/support/planned.h"
#include "tests/support/rest_watch.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;
using executor::State;
using sim::FaultPhase;

struct Seen {
  State state = State::kWaiting;
  double force_N = 0.0;
  std::int64_t at_ns = -1;
};

TEST(FaultPhases, EachBeginsWhereTheExecutorIsInIt) {
  for (const char* name : {"gantry3", "csp6"}) {
    const Cell cell = shipped_cell(name);
    const auto [task, plan] = planned_box(cell, "1");
    WholeRun run(cell, task, plan, with_faults({}));
    ASSERT_TRUE(run.prepare());
    std::array<Seen, sim::kFaultPhases> seen;
    while (run.cycle()) {
      for (std::size_t i = 0; i < seen.size(); ++i) {
        const auto began_ns = run.phases().began_ns(static_cast<FaultPhase>(i));
        if (!began_ns || seen[i].at_ns >= 0) continue;
        seen[i] = {run.controller().state(), run.result().truth.contact_force_N_max, *began_ns};
      }
    }
    const auto of = [&](FaultPhase phase) { return seen[static_cast<std::size_t>(phase)]; };
    EXPECT_EQ(of(FaultPhase::kEnabling).state, State::kWaiting) << name;
    EXPECT_EQ(of(FaultPhase::kFree).state, State::kRunning) << name;
    EXPECT_EQ(of(FaultPhase::kFree).force_N, 0.0) << name;
    EXPECT_EQ(of(FaultPhase::kContact).state, State::kRunning) << name;
    EXPECT_GT(of(FaultPhase::kContact).force_N, 0.0) << name;
    EXPECT_EQ(of(FaultPhase::kSliding).state, State::kRunning) << name;
    EXPECT_EQ(of(FaultPhase::kStopping).state, State::kDisabling) << name;
    EXPECT_LT(of(FaultPhase::kEnabling).at_ns, of(FaultPhase::kFree).at_ns) << name;
    EXPECT_LT(of(FaultPhase::kFree).at_ns, of(FaultPhase::kContact).at_ns) << name;
    EXPECT_LT(of(FaultPhase::kContact).at_ns, of(FaultPhase::kSliding).at_ns) << name;
    EXPECT_LT(of(FaultPhase::kSliding).at_ns, of(FaultPhase::kStopping).at_ns) << name;
  }
}

TEST(FaultPhases, FaultsOfBusAndDevicesStrikeThere) {
  for (const char* kind : {"drop:node=1,duration_s=100", "emergency:node=1,code=0x3210"}) {
    for (const FaultPhase phase :
         {FaultPhase::kEnabling, FaultPhase::kFree, FaultPhase::kContact, FaultPhase::kSliding}) {
      const std::string spec = std::string(kind) + ",at=" + sim::to_string(phase);
      WholeRun run(gantry_cell(), box_task(), box_plan("1"), with_faults({spec}));
      const auto result = run.run();
      ASSERT_EQ(result.ending.reason, EndReason::kArmFault) << spec << ": " << result.reason;
      const auto began_ns = run.phases().began_ns(phase);
      ASSERT_TRUE(began_ns.has_value()) << spec;
      // Quick stop, disabling without an answer and watching the brakes come after it.
      EXPECT_LT(static_cast<double>(run.now_ns() - *began_ns), 5e9) << spec;
    }
  }
}

TEST(FaultPhases, AFaultStrikesInTheStepOfThePlanThatItWaitsFor) {
  for (const char* name : {"gantry3", "csp6"}) {
    const Cell cell = shipped_cell(name);
    const auto [task, plan] = planned_box(cell, "1");
    for (const int step : {0, 1, 4, 10}) {
      const std::string spec = "emergency:node=1,code=0x3210,at=step:" + std::to_string(step);
      WholeRun run(cell, task, plan, with_faults({spec}));
      const auto result = run.run();
      EXPECT_EQ(result.ending.reason, EndReason::kArmFault) << name << " " << spec;
      EXPECT_EQ(result.steps, static_cast<std::size_t>(step)) << name << ": " << result.reason;
    }
  }
}

// The plan is done, its drives are told to go off, and some power is left.
TEST(FaultPhases, WhatStrikesADonePlanWhileItsPowerGoesIsNamed) {
  for (const char* name : {"gantry3", "csp6"}) {
    const Cell cell = shipped_cell(name);
    const auto [task, plan] = planned_box(cell, "1");
    const std::string jump = name == std::string("csp6") ? "jump_rad=0.3" : "jump_m=0.3";
    const std::pair<std::string, EndReason> faults[] = {
        {"encoder-jump:node=2,at=stopping," + jump, EndReason::kEncoderJump},
        {"emergency:node=3,at=stopping,code=0x3210", EndReason::kArmFault},
        {"emergency:node=1,at=stopping,time_s=0.3,code=0x3210", EndReason::kArmFault},
        {"drop:node=1,at=stopping,id=answers,duration_s=100", EndReason::kArmFault},
        {"forged-force:at=stopping,force_N=80,duration_s=0.01", EndReason::kForceFault}};
    for (const auto& [spec, reason] : faults) {
      WholeRun run(cell, task, plan, with_faults({spec}));
      const auto result = run.run();
      EXPECT_EQ(result.ending.reason, reason) << name << " " << spec << ": " << result.reason;
      for (const auto& drive : result.truth.drives) EXPECT_TRUE(drive.brake_engaged) << spec;
    }
  }
}

/// Whose joint is told to go farthest in the tenth of a second from a tenth after the first motion
/// on, in words of a fault.
std::string early_mover(const Cell& cell, const Task& task, const Plan& plan) {
  WholeRun run(cell, task, plan, with_faults({}));
  if (!run.prepare()) return "node=1";
  JointVector from{};
  JointVector to{};
  while (run.cycle()) {
    const auto began_ns = run.phases().began_ns(FaultPhase::kFree);
    if (!began_ns || run.now_ns() < *began_ns + 100'000'000) {
      from = run.controller().record().position_commanded;
    } else if (run.now_ns() < *began_ns + 200'000'000) {
      to = run.controller().record().position_commanded;
    } else {
      break;
    }
  }
  std::size_t farthest = 0;
  for (std::size_t i = 1; i < cell.robot.joints.size(); ++i) {
    if (std::abs(to[i] - from[i]) > std::abs(to[farthest] - from[farthest])) farthest = i;
  }
  return "node=" + std::to_string(cell.robot.joints[farthest].node);
}

// Answers or setpoints of one drive alone.
TEST(FaultPhases, OnlyADrivesAnswersOrOnlyItsSetpointsAreLost) {
  for (const char* name : {"gantry3", "csp6"}) {
    const Cell cell = shipped_cell(name);
    const auto [task, plan] = planned_box(cell, "1");
    const std::string node = early_mover(cell, task, plan);
    for (const char* id : {"answers", "rpdo"}) {
      const std::string spec =
          "drop:" + node + ",at=free,time_s=0.1,duration_s=100,id=" + std::string(id);
      WholeRun run(cell, task, plan, with_faults({spec}));
      const auto result = run.run();
      const bool answers = std::string(id) == "answers";
      EXPECT_EQ(result.ending.reason, answers ? EndReason::kArmFault : EndReason::kFollowingError)
          << name << " " << spec << ": " << result.reason;
      if (answers) {
        EXPECT_EQ(result.ending.arm_fault.kind, ArmFaultKind::kFeedbackMissing);
      }
      RestWatch rest(cell.robot);
      run.leave_alone(1.5);  // more than the heartbeat's timeout, a ramp and a brake
      rest.look(run.result().truth);
      EXPECT_EQ(rest.complaints(), "") << name << " " << spec;
    }
  }
}

// While the sensor is tared nothing is commanded that a joint could fail to follow: only the drive
// itself can tell.
TEST(FaultPhases, AtRestADriveMissesItsSetpointsByItself) {
  for (const char* name : {"gantry3", "csp6"}) {
    const Cell cell = shipped_cell(name);
    const auto [task, plan] = planned_box(cell, "1");
    WholeRun run(cell, task, plan,
                 with_faults({"drop:node=1,at=enabling,time_s=0.02,id=rpdo,duration_s=100"}));
    ASSERT_TRUE(run.prepare());
    State last = State::kWaiting;
    while (run.cycle()) {
      if (run.controller().ending().reason == EndReason::kNone) last = run.controller().state();
    }
    const auto result = run.result();
    EXPECT_LT(last, State::kRunning) << name << ": " << result.reason;
    EXPECT_EQ(result.ending.reason, EndReason::kArmFault) << name << ": " << result.reason;
    EXPECT_EQ(result.ending.arm_fault.kind, ArmFaultKind::kDriveFault) << name;
    EXPECT_EQ(result.ending.arm_fault.node, 1) << name;
    EXPECT_NE(result.reason.find("RPDO"), std::string::npos) << result.reason;
  }
}

}  // namespace
}  // namespace tenon::tests
