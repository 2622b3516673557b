// A whole planning, short enough for the sanitizers.

#include <gtest/gtest.h>

#include "planner/planner.h"
#include "shared/config/load.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "tests/support/places.h"

namespace tenon::planner {
namespace {

TEST(WholePlanning, OfTheToyEndsEveryParticleAtTheGoal) {
  const Task task = load_task(tests::in_tree("planner/tasks/toy_1d.yaml"));
  PlannerOptions options;
  options.draws = 20;
  const PlanReport report =
      make_plan(task, task.starts.front(), sim::OdeRollout(task), options, [] { return 0.0; });
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  EXPECT_TRUE(report.certification.holds());
  for (const VariantRun& run : report.certification.runs) {
    for (const Chain& chain : run.chains) {
      const Vector3 off_m = chain.end().position_m - task.goal.position_m;
      EXPECT_LE(off_m.norm(), task.goal_tolerance_m) << run.variant.name;
    }
  }
}

}  // namespace
}  // namespace tenon::planner
