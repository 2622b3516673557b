// The demo of every cell in the tree, in virtual time: planned for the cell, executed where seeds 1
// to 10 put the table.

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "executor/dry_run/dry_run.h"
#include "executor/dry_run/plan_check.h"
#include "shared/base/error.h"
#include "shared/config/load.h"
#include "sim/cell/virtual_arm/environment_offset.h"
#include "sim/cell/virtual_arm/start_joints.h"
#include "tests/support/places.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

class ShippedCell : public ::testing::TestWithParam<const char*> {};

TEST_P(ShippedCell, BringsTheBoxToItsGoalWhereverTheDemosSeedsPutTheTable) {
  const Cell cell = shipped_cell(GetParam());
  const Start& start = box_start("1");
  const auto [task, plan] = planned_box(cell, start.name);
  ASSERT_TRUE(executor::check_plan(plan, cell).empty());
  const executor::DryRun dry_run = executor::dry_run(plan, cell);
  for (const std::string& refusal : dry_run.refusals) ADD_FAILURE() << refusal;

  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    WholeRun::Options run_options;
    run_options.start = start.name;
    run_options.seed = seed;
    run_options.offset = sim::draw_offset(task, start, seed);
    const auto result = WholeRun(cell, task, plan, run_options).run();
    std::printf("%s, seed %d: table off by x %.1f y %.1f mm, %s, %.2f mm from the goal, %.0f N\n",
                GetParam(), static_cast<int>(seed), 1e3 * run_options.offset[0],
                1e3 * run_options.offset[1], result.reason.c_str(), 1e3 * result.truth.error_norm_m,
                result.truth.contact_force_N_max);
    EXPECT_EQ(result.ending.reason, executor::EndReason::kPlanDone)
        << "seed " << seed << ": " << result.reason;
    EXPECT_LT(result.truth.error_norm_m, task.goal_tolerance_m) << "seed " << seed;
  }
}

// By the walls that a plan for no cell in particular touches from there, the executor refuses it:
// 0.05 mm beyond the arm's continuous reach.
TEST(ShippedArmCell, ExecutesThePlanThatWasMadeForItAtTheRimOfItsReach) {
  const Cell cell = shipped_cell("csp6");
  EXPECT_TRUE(executor::dry_run(planned_box(cell, "2").plan, cell).refusals.empty());
}

TEST(ShippedPegCell, ReachesTheStartOfTheFinePegWhichTheTablesCellDoesNot) {
  const Task task = load_task(in_tree("planner/tasks/peg_in_hole_2d_fine.yaml"));
  const Pose& start = task.starts.front().pose;
  EXPECT_NO_THROW((void)sim::start_joints(shipped_cell("gantry3_peg"), start));
  EXPECT_THROW((void)sim::start_joints(gantry_cell(), start), InputError);
}

std::string cell_name(const ::testing::TestParamInfo<const char*>& info) { return info.param; }

INSTANTIATE_TEST_SUITE_P(Tree, ShippedCell, ::testing::Values("gantry3", "csp6", "mit6"),
                         cell_name);
INSTANTIATE_TEST_SUITE_P(Full, ShippedCell, ::testing::Values("lwa4p"), cell_name);

}  // namespace
}  // namespace tenon::tests
