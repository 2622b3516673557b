// The demo of every cell in the tree, in virtual time: planned for the cell, executed where seeds 1
// to 10 put the table.

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "executor/dry_run/dry_run.h"
#include "executor/plan_check.h"
#include "shared/base/error.h"
#include "shared/config/load.h"
#include "sim/virtual_arm/environment_offset.h"
#include "sim/virtual_arm/start_joints.h"
#include "tests/chain/planned.h"
#include "tests/support/lockstep.h"

namespace tenon::tests {
namespace {

class ShippedCell : public ::testing::TestWithParam<const char*> {};

TEST_P(ShippedCell, BringsTheBoxToItsGoalWhereverTheDemosSeedsPutTheTable) {
  const std::filesystem::path tree = TENON_SOURCE_DIR;
  const Cell cell = load_cell(tree / "hw/cells" / (std::string(GetParam()) + ".yaml"));
  const Start& start = box_start("1");
  const auto [task, plan] = plan_box(cell, start.name);
  ASSERT_TRUE(executor::check_plan(plan, cell).empty());
  const executor::DryRun dry_run = executor::dry_run(plan, cell);
  for (const std::string& refusal : dry_run.refusals) ADD_FAILURE() << refusal;

  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Lockstep::Options run_options;
    run_options.start = start.name;
    run_options.seed = seed;
    run_options.offset = sim::draw_offset(start, task.coordinates, seed);
    const auto result = Lockstep(cell, task, plan, run_options).run();
    std::printf("%s, seed %d: table off by x %.1f y %.1f mm, %s, %.2f mm from the goal, %.0f N\n",
                GetParam(), static_cast<int>(seed), 1e3 * run_options.offset[0],
                1e3 * run_options.offset[1], result.reason.c_str(), 1e3 * result.truth.error_norm_m,
                result.truth.contact_force_N_max);
    EXPECT_EQ(result.ending.reason, executor::EndReason::kPlanDone)
        << "seed " << seed << ": " << result.reason;
    EXPECT_LT(result.truth.error_norm_m, task.goal_tolerance_m) << "seed " << seed;
  }
}

TEST(ShippedPegCell, ReachesTheStartOfTheFinePegWhichTheTablesCellDoesNot) {
  const std::filesystem::path tree = TENON_SOURCE_DIR;
  const Task task = load_task(tree / "planner/tasks/peg_in_hole_2d_fine.yaml");
  const Pose& start = task.starts.front().pose;
  EXPECT_NO_THROW((void)sim::start_joints(load_cell(tree / "hw/cells/gantry3_peg.yaml"), start));
  EXPECT_THROW((void)sim::start_joints(load_cell(tree / "hw/cells/gantry3.yaml"), start),
               InputError);
}

INSTANTIATE_TEST_SUITE_P(Tree, ShippedCell, ::testing::Values("gantry3", "csp6", "lwa4p"),
                         [](const auto& cell) { return std::string(cell.param); });

}  // namespace
}  // namespace tenon::tests
