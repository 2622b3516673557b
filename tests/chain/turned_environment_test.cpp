// A tray that lies askew, over the whole chain: an arm with six axes presses the box flat, follows
// the tray's own directions, and stands in it as the task wants.

#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "executor/dry_run/dry_run.h"
#include "executor/dry_run/plan_check.h"
#include "planner/cell_fit/cell_fit.h"
#include "shared/config/load.h"
#include "sim/cell/virtual_arm/environment_offset.h"
#include "tests/support/places.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;

class TurnedEnvironment : public ::testing::Test {
 protected:
  TurnedEnvironment() { options.start = task.starts.front().name; }

  WholeRun::Result run(const Vector6& offset) {
    options.offset = offset;
    return WholeRun(cell, task, plan, options).run();
  }

  Cell cell = shipped_cell("csp6");
  Task task =
      planner::fit_to_cell(load_task(in_tree("planner/tasks/box_on_table_se2.yaml")), cell).task;
  Plan plan = load_plan(shared_plan("box_se2_csp6"));
  WholeRun::Options options;
};

TEST_F(TurnedEnvironment, TheArmTakesThePlan) {
  EXPECT_TRUE(executor::check_plan(plan, cell).empty());
  for (const std::string& refusal : executor::dry_run(plan, cell).refusals) {
    ADD_FAILURE() << refusal;
  }
}

class TurnedTray : public TurnedEnvironment, public ::testing::WithParamInterface<int> {};

TEST_P(TurnedTray, TheBoxEndsAtItsPlaceAndAsItLies) {
  for (int i = 0; i < 2; ++i) {
    const auto seed = static_cast<std::uint64_t>(GetParam() + i);
    const Vector6 offset = sim::draw_offset(task, task.starts.front(), seed);
    const WholeRun::Result result = run(offset);
    std::printf(
        "tray off by x %.1f y %.1f mm, rz %.2f deg: %s, %.2f mm and %.3f deg from the goal\n",
        1e3 * offset[0], 1e3 * offset[1], offset[5] / kDegree_rad, result.reason.c_str(),
        1e3 * result.truth.error_norm_m, result.truth.error_norm_rad / kDegree_rad);
    EXPECT_EQ(result.ending.reason, executor::EndReason::kPlanDone) << result.reason;
    EXPECT_TRUE(result.truth.within_tolerance);
    EXPECT_LT(result.truth.error_norm_rad, 0.2 * kDegree_rad);
  }
}

INSTANTIATE_TEST_SUITE_P(Tree, TurnedTray, ::testing::Values(1),
                         ::testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Full, TurnedTray, ::testing::Values(3, 5),
                         ::testing::PrintToStringParamName());

// Five degrees either way at once with the tray's worst place.
TEST_F(TurnedEnvironment, AtTheRimOfItsReachToo) {
  for (const double turned_rad : {-0.087, 0.087}) {
    Vector6 offset = Vector6::Zero();
    offset << 0.02, -0.02, 0.0, 0.0, 0.0, turned_rad;
    const WholeRun::Result result = run(offset);
    EXPECT_EQ(result.ending.reason, executor::EndReason::kPlanDone) << result.reason;
    EXPECT_LT(result.truth.error_norm_rad, 0.2 * kDegree_rad);
  }
}

// The same plan with its axes left to the task frame: the box goes beside its place.
TEST_F(TurnedEnvironment, WithoutTheAxesThatItCarriesTheBoxMissesItsPlace) {
  plan.parameter_sets.front().carried_axes = false;
  Vector6 offset = Vector6::Zero();
  offset[5] = 0.08;
  EXPECT_FALSE(run(offset).truth.within_tolerance);
}

}  // namespace
}  // namespace tenon::tests
