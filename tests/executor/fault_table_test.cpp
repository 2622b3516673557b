// The table of faults: complete, consistent, the one that README.md prints, and the one whose
// bounds the detectors have.

#include "executor/faults/fault_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "executor/faults/fault_bounds.h"
#include "executor/loop/controller.h"
#include "executor/sensing/following_watch.h"
#include "shared/config/files.h"
#include "tests/support/places.h"

namespace tenon::executor {
namespace {

std::string line_of(const FaultRow& row) {
  std::string name = std::string("`") + row.name + "`";
  if (row.reason == EndReason::kArmFault) name += std::string(" ") + row.arm_fault_name;
  const std::string bound = to_string(row.bound);
  const std::string within = bound.empty() ? "" : bound + " from " + row.since;
  return "| " + name + " | " + row.detector + " | " + within + " | " + to_string(row.reaction) +
         " | " + to_string(row.end_state) + " |";
}

/// Of README.md's section on why a run ended.
std::vector<std::string> lines_of_readme() {
  const std::string text = config::read_file(tests::in_tree("executor/README.md"));
  const std::size_t begin = text.find("\n## Why a run ended");
  const std::size_t end = text.find("\n## ", begin + 1);
  std::vector<std::string> lines;
  std::size_t at = begin;
  while (at < end) {
    const std::size_t next = std::min(text.find('\n', at + 1), end);
    const std::string line = text.substr(at + 1, next - at - 1);
    if (line.rfind("| `", 0) == 0) lines.push_back(line);
    at = next;
  }
  return lines;
}

TEST(FaultTable, EveryReasonAndEveryFaultOfTheArmHasOneRow) {
  std::set<std::pair<EndReason, ArmFaultKind>> rows;
  std::set<std::string> names;
  for (const FaultRow& row : fault_table()) {
    EXPECT_TRUE(rows.insert({row.reason, row.arm_fault}).second) << full_name(row);
    EXPECT_TRUE(names.insert(full_name(row)).second) << full_name(row);
    EXPECT_STRNE(row.detector, "") << full_name(row);
    EXPECT_EQ(fault_row(row.reason, row.arm_fault), &row);
    EXPECT_STREQ(to_string(row.reason), row.name);
    EXPECT_EQ(end_manner(row.reason), row.reaction) << "one reaction a reason";
    EXPECT_EQ(row.reason == EndReason::kArmFault, row.arm_fault != ArmFaultKind::kNone);
    EXPECT_EQ(to_string(row.bound).empty(), std::string(row.since).empty()) << full_name(row);
  }
  for (int reason = 1; reason <= static_cast<int>(kLastEndReason); ++reason) {
    if (reason == static_cast<int>(EndReason::kArmFault)) continue;
    EXPECT_NE(fault_row(static_cast<EndReason>(reason)), nullptr) << reason;
  }
  for (int kind = 1; kind <= static_cast<int>(ArmFaultKind::kOtherMaster); ++kind) {
    EXPECT_NE(fault_row(EndReason::kArmFault, static_cast<ArmFaultKind>(kind)), nullptr) << kind;
  }
  EXPECT_EQ(fault_row(EndReason::kNone), nullptr);
  EXPECT_STREQ(to_string(EndReason::kNone), "none");
}

TEST(FaultTable, IsTheOneThatTheReadmePrints) {
  std::vector<std::string> expected;
  for (const FaultRow& row : fault_table()) expected.push_back(line_of(row));
  EXPECT_EQ(lines_of_readme(), expected);
}

// Those that wait do so for as long as the table says.
TEST(FaultTable, TheDetectorsHaveItsBounds) {
  const ControlTask::Parameters parameters;
  Robot robot;
  robot.cycle_us = 2000;
  const auto seconds = [](EndReason reason) { return fault_row(reason)->bound.time_s; };
  const auto cycles = [](EndReason reason) { return fault_row(reason)->bound.cycles; };
  EXPECT_EQ(seconds(EndReason::kWrenchMissing), parameters.supervision.wrench_age_max_s);
  EXPECT_EQ(seconds(EndReason::kBlind), parameters.supervision.blind_max_s);
  EXPECT_EQ(seconds(EndReason::kEnableTimeout), parameters.enable_timeout_s);
  EXPECT_EQ(seconds(EndReason::kBrakeFailed), parameters.brake_creep_s);
  EXPECT_EQ(kBrakeWatch_s, parameters.brake_watch_s);
  EXPECT_EQ(seconds(EndReason::kNotHeld), kHeldPatience_s);
  EXPECT_EQ(seconds(EndReason::kNotDisabled), parameters.disable_timeout_s);
  EXPECT_EQ(cycles(EndReason::kFeedbackMissing), parameters.supervision.feedback_misses_max + 2);
  EXPECT_EQ(bound_cycles(*fault_row(EndReason::kFollowingError), robot),
            FollowingWatch(robot).cycles_max() + 2);
}

TEST(FaultTable, BoundsInCyclesAreTheRobots) {
  Robot robot;
  robot.cycle_us = 10000;
  robot.heartbeat_ms = 100;
  robot.heartbeat_timeout_ms = 305;
  const auto of_arm = [&](ArmFaultKind kind) {
    return bound_cycles(*fault_row(EndReason::kArmFault, kind), robot);
  };
  EXPECT_EQ(of_arm(ArmFaultKind::kHeartbeatLost), 31 + 2);
  EXPECT_EQ(of_arm(ArmFaultKind::kUnexpectedReset), 10 + 2);
  EXPECT_EQ(of_arm(ArmFaultKind::kBusDown), 2);
  EXPECT_EQ(bound_cycles(*fault_row(EndReason::kWrenchMissing), robot), 5 + 8 + 2);
  EXPECT_EQ(bound_cycles(*fault_row(EndReason::kPlanFailed), robot), std::nullopt);

  EXPECT_EQ(of_arm(ArmFaultKind::kSensorStale), 8);
  EXPECT_EQ(of_arm(ArmFaultKind::kSensorInvalid), 2);
  robot.sensor.cycles_per_sample = 3;
  EXPECT_EQ(of_arm(ArmFaultKind::kSensorStale), 6 * 3 + 2);
  EXPECT_EQ(of_arm(ArmFaultKind::kSensorInvalid), 3 + 1);
  EXPECT_EQ(bound_cycles(*fault_row(EndReason::kWrenchFrozen), robot), 72 * 3 + 2);
  EXPECT_EQ(of_arm(ArmFaultKind::kBusDown), 2);
}

TEST(FaultTable, AMaskTakesAwayItsRowAlone) {
  FaultMask mask;
  EXPECT_FALSE(mask.masks(EndReason::kForceFault, ArmFaultKind::kNone));
  mask.mask(EndReason::kForceFault);
  mask.mask(EndReason::kArmFault, ArmFaultKind::kBusOff);
  EXPECT_TRUE(mask.masks(EndReason::kForceFault, ArmFaultKind::kNone));
  EXPECT_FALSE(mask.masks(EndReason::kTorqueFault, ArmFaultKind::kNone));
  EXPECT_TRUE(mask.masks(EndReason::kArmFault, ArmFaultKind::kBusOff));
  EXPECT_FALSE(mask.masks(EndReason::kArmFault, ArmFaultKind::kBusDown));
}

}  // namespace
}  // namespace tenon::executor
