// The arm stands where another start of the task is, and the plan begins elsewhere.

#include <gtest/gtest.h>

#include <string>

#include "shared/config/load.h"
#include "tests/chain/planned.h"
#include "tests/support/lockstep.h"

namespace tenon::tests {
namespace {

using executor::EndReason;

Cell six_axis_cell() { return load_cell(TENON_SOURCE_DIR "/hw/cells/csp6.yaml"); }

// Stands at start 1, which is 0.6 m from the start of the plan.
Lockstep::Result run_from_another_start(const Cell& cell, bool go_to_start) {
  Lockstep::Options options;
  options.start = "1";
  options.offset[0] = 0.01;
  options.controller.go_to_start = go_to_start;
  return Lockstep(cell, box_task(), box_plan("4"), options).run();
}

TEST(GoToStart, WithoutItTheRunEndsBeforeAnythingMovesAndNamesTheAxis) {
  const auto result = run_from_another_start(gantry_cell(), false);
  EXPECT_EQ(result.ending.reason, EndReason::kNotAtStart);
  EXPECT_EQ(result.reason.rfind("the tool's x is at -0.3", 0), 0U) << result.reason;
  EXPECT_NE(result.reason.find("has it at 0.3000"), std::string::npos) << result.reason;
  EXPECT_NE(result.reason.find("--go-to-start"), std::string::npos) << result.reason;
  EXPECT_EQ(result.steps, 0U);
}

TEST(GoToStart, AGantryGoesThereAndThePlanReachesItsGoal) {
  const auto result = run_from_another_start(gantry_cell(), true);
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
  EXPECT_LT(result.truth.error_norm_m, box_task().goal_tolerance_m);
}

// Straight in the joints is an arc of the tool, and the part hangs 2 mm above the table.
TEST(GoToStart, ASixAxisArmThatTouchesTheTableOnItsWayStopsSoftlyAndSaysSo) {
  const Cell cell = six_axis_cell();
  const auto result = run_from_another_start(cell, true);
  EXPECT_EQ(result.ending.reason, EndReason::kContactOnApproach) << result.reason;
  EXPECT_EQ(result.reason.rfind("touched something on the way to the start: z reads", 0), 0U)
      << result.reason;
  EXPECT_LT(result.truth.contact_force_N_max, cell.force_fault_N);
  for (const auto& drive : result.truth.drives) EXPECT_TRUE(drive.brake_engaged) << drive.joint;
}

}  // namespace
}  // namespace tenon::tests
