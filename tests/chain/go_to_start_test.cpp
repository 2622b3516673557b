// The arm stands elsewhere than where the plan begins.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "executor/dry_run/dry_run.h"
#include "executor/motion/tool_kinematics.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;

// Stands at start 1, which is 0.6 m from the start of the plan.
WholeRun::Result run_from_another_start(const Cell& cell, bool go_to_start) {
  WholeRun::Options options;
  options.start = "1";
  options.offset[0] = 0.01;
  options.controller.go_to_start = go_to_start;
  return WholeRun(cell, box_task(), box_plan("4"), options).run();
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
  const Cell cell = shipped_cell("csp6");
  const auto result = run_from_another_start(cell, true);
  EXPECT_EQ(result.ending.reason, EndReason::kContactOnApproach) << result.reason;
  EXPECT_EQ(result.reason.rfind("touched something on the way to the start: z reads", 0), 0U)
      << result.reason;
  EXPECT_LT(result.truth.contact_force_N_max, cell.force_fault_N);
  for (const auto& drive : result.truth.drives) EXPECT_TRUE(drive.brake_engaged) << drive.joint;
}

// --- from joint positions away from the start
// -----------------------------------------------------

class SixAxisGoToStart : public ::testing::TestWithParam<const char*> {
 protected:
  // 0.12 m above the start, 0.16 m beside it and turned: every joint stands elsewhere.
  [[nodiscard]] JointVector away() const {
    const JointVector start = executor::dry_run(planned.plan, cell).start.value();
    const Vector6 off{{0.15, 0.05, 0.12, 0.10, -0.10, 0.20}};
    const executor::ToolKinematics kinematics(cell);
    const auto found = kinematics.joints(displaced(planned.plan.start, off), start);
    EXPECT_EQ(found.status, SerialChain::InverseStatus::kSolved);
    for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
      EXPECT_GT(std::abs(found.position[i] - start[i]), 0.01) << cell.robot.joints[i].name;
    }
    return found.position;
  }

  [[nodiscard]] WholeRun::Options from_away() const {
    WholeRun::Options options;
    options.start = "1";
    options.joints = away();
    options.controller.go_to_start = true;
    return options;
  }

  static void expect_brakes(const sim::Truth& truth) {
    for (const auto& drive : truth.drives) EXPECT_TRUE(drive.brake_engaged) << drive.joint;
    EXPECT_EQ(truth.faults, 0U);
  }

  Cell cell = shipped_cell(GetParam());
  const Planned planned = planned_box(cell, "1");
};

TEST_P(SixAxisGoToStart, TheToolComesToTheNominalStartAndThePlanToItsGoal) {
  WholeRun chain(cell, planned.task, planned.plan, from_away());
  ASSERT_TRUE(chain.prepare());
  while (chain.controller().state() < executor::State::kRunning) ASSERT_TRUE(chain.cycle());
  const Vector6 off = displacement_between(planned.plan.start, chain.cell().truth().tool);
  EXPECT_LT(off.head<3>().norm(), 1e-3);
  EXPECT_LT(off.tail<3>().norm(), 3e-3);
  std::printf("%s: at the start within %.2f mm and %.2f mrad after %.1f s\n", GetParam(),
              1e3 * off.head<3>().norm(), 1e3 * off.tail<3>().norm(),
              1e-9 * static_cast<double>(chain.now_ns()));
  while (chain.cycle()) {
  }
  const auto result = chain.result();
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
  EXPECT_LT(result.truth.error_norm_m, planned.task.goal_tolerance_m);
  expect_brakes(result.truth);
}

// A post that reaches as high as the arm stands, between it and the start.
TEST_P(SixAxisGoToStart, APostInTheWayStopsItSoftlyAndByName) {
  Task task = planned.task;
  Shape post{"post", Shape::Kind::kBox, {0.05, 0.30, 0.20}, {}};
  post.pose.position_m = {-0.27, -0.15, 0.10};
  task.environment.push_back(post);
  const auto result = WholeRun(cell, task, planned.plan, from_away()).run();
  EXPECT_EQ(result.ending.reason, EndReason::kContactOnApproach) << result.reason;
  EXPECT_EQ(result.reason.rfind("touched something on the way to the start: ", 0), 0U)
      << result.reason;
  EXPECT_EQ(result.steps, 0U);
  EXPECT_GT(result.truth.contact_force_N_max, 0.0);
  EXPECT_LT(result.truth.contact_force_N_max, cell.force_fault_N);
  expect_brakes(result.truth);
  std::printf("%s: %s, at most %.1f N\n", GetParam(), result.reason.c_str(),
              result.truth.contact_force_N_max);
}

std::string arm_name(const ::testing::TestParamInfo<const char*>& info) { return info.param; }

INSTANTIATE_TEST_SUITE_P(Arms, SixAxisGoToStart, ::testing::Values("csp6"), arm_name);
INSTANTIATE_TEST_SUITE_P(Full, SixAxisGoToStart, ::testing::Values("lwa4p"), arm_name);

}  // namespace
}  // namespace tenon::tests
