// The way in for a library's user: what is left out has a safe meaning.

#include <gtest/gtest.h>

#include "planner/planner.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

TEST(MakePlan, WithoutOptionsAndClockWritesTheSameBytesAndMeasuresNoTime) {
  const Task task = room_task();
  const WallRollout rollout(room());
  const PlanReport report = make_plan(task, task.starts.front(), rollout);
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  double now_s = 0.0;
  const auto clock = [&] { return now_s += 1e-6; };
  EXPECT_EQ(report.bytes, make_plan(task, task.starts.front(), rollout, {}, clock).bytes);
  EXPECT_EQ(report.times.search_s, 0.0);
  EXPECT_EQ(report.judging.time_s(), 0.0);
}

TEST(MakePlan, WithoutAssumptionsTakesTheStiffnessOfTheTask) {
  Task task = room_task();
  task.contact_stiffness_Npm = 2e4;
  const PlanReport report = make_plan(task, task.starts.front(), WallRollout(room()));
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  EXPECT_EQ(report.plan->contact_stiffness_Npm, 2e4);
  EXPECT_FLOAT_EQ(static_cast<float>(report.plan->latency_max_s), 0.010F);
}

TEST(MakePlan, TakesTheStiffnessAndLatencyOfTheCellThatItIsToldOf) {
  const Task task = room_task();
  PlannerOptions options;
  options.assumptions = CellAssumptions{3e4, 0.025};
  const PlanReport report = make_plan(task, task.starts.front(), WallRollout(room()), options);
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  EXPECT_EQ(report.plan->contact_stiffness_Npm, 3e4);
  EXPECT_FLOAT_EQ(static_cast<float>(report.plan->latency_max_s), 0.025F);
}

}  // namespace
}  // namespace tenon::planner
