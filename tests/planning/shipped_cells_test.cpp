// The demo of every cell in the tree, in virtual time: planned for the cell, executed where seeds 1
// to 10 put the table, or what a part of our own goes into.

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "executor/dry_run/dry_run.h"
#include "executor/dry_run/plan_check.h"
#include "planner/cell_fit/cell_fit.h"
#include "planner/judge/certification.h"
#include "shared/base/error.h"
#include "shared/config/load.h"
#include "sim/cell/virtual_arm/environment_offset.h"
#include "sim/cell/virtual_arm/start_joints.h"
#include "tests/support/places.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

/// Executed on the cell where seeds 1 to 10 put the environment.
void expect_goal_for_the_demos_seeds(const Cell& cell, const Planned& planned) {
  const auto& [task, plan] = planned;
  ASSERT_TRUE(executor::check_plan(plan, cell).empty());
  const executor::DryRun dry_run = executor::dry_run(plan, cell);
  for (const std::string& refusal : dry_run.refusals) ADD_FAILURE() << refusal;

  const Start& start = planner::start_of(plan, task);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    WholeRun::Options run_options;
    run_options.start = start.name;
    run_options.seed = seed;
    run_options.offset = sim::draw_offset(task, start, seed);
    const auto result = WholeRun(cell, task, plan, run_options).run();
    std::printf("%s, seed %d: off by x %.1f y %.1f z %.1f mm, %s, %.2f mm from the goal, %.0f N\n",
                cell.name.c_str(), static_cast<int>(seed), 1e3 * run_options.offset[0],
                1e3 * run_options.offset[1], 1e3 * run_options.offset[2], result.reason.c_str(),
                1e3 * result.truth.error_norm_m, result.truth.contact_force_N_max);
    EXPECT_EQ(result.ending.reason, executor::EndReason::kPlanDone)
        << "seed " << seed << ": " << result.reason;
    EXPECT_TRUE(result.truth.within_tolerance) << "seed " << seed;
  }
}

class ShippedCell : public ::testing::TestWithParam<const char*> {};

TEST_P(ShippedCell, BringsTheBoxToItsGoalWhereverTheDemosSeedsPutTheTable) {
  const Cell cell = shipped_cell(GetParam());
  expect_goal_for_the_demos_seeds(cell, planned_box(cell, "1"));
}

// Parts of our own, of triangles, whose plan is named as they and the cell are.
class ShippedBench : public ::testing::TestWithParam<const char*> {};

TEST_P(ShippedBench, PlugsThePartInWhereverTheDemosSeedsPutWhatItGoesInto) {
  const Cell cell = shipped_cell("csp6_bench");
  const std::string name = GetParam();
  const Task task = load_task(in_tree("planner/tasks/" + name + ".yaml"));
  const Planned planned = {planner::fit_to_cell(task, cell).task,
                           load_plan(shared_plan(name + "_" + cell.name))};
  expect_goal_for_the_demos_seeds(cell, planned);
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

// Above the round peg's start, as far as it is uncertain: its arm had ended 50 mm below.
TEST(ShippedPegCell, ReachesAllThatIsAboveTheStartsOfTheTasksThatTheDemoGivesIt) {
  const Cell cell = shipped_cell("gantry3_peg");
  for (const char* name :
       {"peg_in_hole_2d", "peg_in_hole_2d_fine", "peg_in_hole_3d", "box_on_table_3d"}) {
    const Task task = load_task(in_tree(std::string("planner/tasks/") + name + ".yaml"));
    for (const Start& start : task.starts) {
      Pose highest = start.pose;
      highest.position_m.z() += task.particle_sigmas * start.sigma[2];
      EXPECT_NO_THROW((void)sim::start_joints(cell, highest)) << name;
    }
  }
}

std::string param_name(const ::testing::TestParamInfo<const char*>& info) { return info.param; }

INSTANTIATE_TEST_SUITE_P(Tree, ShippedCell, ::testing::Values("gantry3", "csp6", "mit6"),
                         param_name);
INSTANTIATE_TEST_SUITE_P(Full, ShippedCell, ::testing::Values("lwa4p"), param_name);
INSTANTIATE_TEST_SUITE_P(Tree, ShippedBench, ::testing::Values("connector"), param_name);
INSTANTIATE_TEST_SUITE_P(Full, ShippedBench, ::testing::Values("keyed_peg"), param_name);

}  // namespace
}  // namespace tenon::tests
