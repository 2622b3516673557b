// A task made for a fast arm, planned for one with a cycle of 10 ms, and executed there.

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "executor/dry_run/plan_check.h"
#include "planner/judge/plan_draft.h"
#include "shared/config/load.h"
#include "tests/support/places.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

// The gantry with the bus and the drives of a slow arm.
Cell slow_cell() { return load_cell(in_tree("tests/plans/slow_gantry3/cell.yaml")); }

TEST(ContactAtASlowCycle, APlanOfTheTaskAsItStandsIsRefused) {
  // D = 1500 against 1.5 * 5e4 * 35 ms, and 6 + 5e4 * 0.05 * (80 ms + 2 / 1500).
  const std::array<Vector6, 1> way = {Vector6::Unit(0)};
  Plan plan = planner::draft_plan(box_task(), box_start("1"), {5e4, 0.035}, way);
  plan.method = PlanMethod::kSingleParticle;  // a draft has no envelopes
  const std::vector<std::string> refusals = executor::check_plan(plan, slow_cell());
  ASSERT_GE(refusals.size(), 2U);  // a way along x alone does not lead to the goal either
  EXPECT_NE(refusals[0].find("1500"), std::string::npos) << refusals[0];
  EXPECT_NE(refusals[0].find("2625"), std::string::npos) << refusals[0];
  EXPECT_NE(refusals[1].find("209.333 N"), std::string::npos) << refusals[1];
}

TEST(ContactAtASlowCycle, APlanForTheCellReachesTheGoalWhereverTheTableStands) {
  const Cell cell = slow_cell();
  const Start& start = box_start("1");
  const auto [task, plan] = planned_box(cell, start.name);
  EXPECT_TRUE(executor::check_plan(plan, cell).empty());

  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    double distance = 0.0;
    WholeRun::Options run_options;
    run_options.start = start.name;
    run_options.seed = seed;
    run_options.offset = draw_offset(task, start, seed, distance);
    const auto result = WholeRun(cell, task, plan, run_options).run();
    EXPECT_EQ(result.ending.reason, executor::EndReason::kPlanDone)
        << "seed " << seed << " at " << distance << " sigma: " << result.reason;
    EXPECT_LT(result.truth.error_norm_m, task.goal_tolerance_m) << "seed " << seed;
    EXPECT_LE(result.truth.contact_force_N_max, 0.8 * cell.force_fault_N) << "seed " << seed;
  }
}

}  // namespace
}  // namespace tenon::tests
