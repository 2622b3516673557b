// The planner's pool of rollouts, each on a thread of its own.

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "planner/planner.h"
#include "shared/config/load.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "tests/support/places.h"

namespace tenon::planner {
namespace {

std::vector<std::uint8_t> plan_on(std::size_t threads) {
  const Task task = load_task(tests::in_tree("planner/tasks/toy_1d.yaml"));
  PlannerOptions options;
  options.threads = threads;
  options.draws = 20;
  const PlanReport report =
      make_plan(task, task.starts.front(), sim::OdeRollout(task), options, [] { return 0.0; });
  EXPECT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  return report.bytes;
}

TEST(PlannerThreads, TheToysPlanIsTheSameByteForByteOnOneAndTwo) {
  EXPECT_EQ(plan_on(2), plan_on(1));
}

}  // namespace
}  // namespace tenon::planner
