// The planner on its real physics.

#include <gtest/gtest.h>

#include "planner/planner.h"
#include "shared/config/load.h"
#include "sim/rollout/ode_rollout.h"

namespace tenon::planner {
namespace {

TEST(PlannerOnOde, PlansTheBoxOnTheTableAndTwoThreadsWriteTheSameBytes) {
  const Task task = load_task(TENON_SOURCE_DIR "/planner/tasks/box_on_table_2d.yaml");
  const sim::OdeRollout rollout(task);
  PlannerOptions options;
  options.validation.draws = 30;  // the executable takes 200 and more
  const auto plan = [&] {
    return make_plan(task, task.starts.at(3), rollout, options, [] { return 0.0; });
  };
  const PlanReport one = plan();
  ASSERT_EQ(one.status, PlanStatus::kPlanned) << one.reason;
  EXPECT_EQ(one.plan->draws_at_goal, one.plan->draws);
  EXPECT_LE(one.bytes.size(), 2048U);
  options.threads = 2;
  EXPECT_EQ(plan().bytes, one.bytes);
}

}  // namespace
}  // namespace tenon::planner
