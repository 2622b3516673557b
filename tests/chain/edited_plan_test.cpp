// A plan that was changed since it was made is not done where it ends: its goal tells, before
// anything moves and at the end.

#include <gtest/gtest.h>

#include <string>

#include "executor/dry_run/plan_check.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;

WholeRun::Result executed(const Plan& plan) {
  WholeRun::Options options;
  options.start = "1";
  return WholeRun(gantry_cell(), box_task(), plan, options).run();
}

void expect_not_at_goal(const Plan& plan) {
  EXPECT_FALSE(executor::check_plan(plan, gantry_cell()).empty());
  const auto result = executed(plan);
  EXPECT_EQ(result.ending.reason, EndReason::kNotAtGoal) << result.reason;
  EXPECT_NE(result.reason.find("not to its goal"), std::string::npos) << result.reason;
  EXPECT_TRUE(result.ending.disable_confirmed);
}

TEST(EditedPlan, TheWholeOneIsAcceptedAndDone) {
  for (const char* start : {"1", "4"}) {
    for (const std::string& line : executor::check_plan(box_plan(start), gantry_cell())) {
      ADD_FAILURE() << line;
    }
  }
  const auto result = executed(box_plan("1"));
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
}

TEST(EditedPlan, OneThatEndsTooSoonIsNotDone) {
  Plan plan = box_plan("1");
  ASSERT_GT(plan.steps.size(), 3U);
  plan.steps.resize(plan.steps.size() - 3);
  for (OutcomeRule& rule : plan.steps.back().outcomes) {
    if (rule.successor != kSuccessorFail) rule.successor = kSuccessorDone;
  }
  expect_not_at_goal(plan);
}

TEST(EditedPlan, OneWhoseLastStepIsShorterIsNotDone) {
  Plan plan = box_plan("1");
  Step& last = plan.steps.back();
  const Vector6 missing = 0.8 * last.displacement;
  last.displacement -= missing;
  for (OutcomeRule& rule : last.outcomes) {
    rule.envelope.travelled_min -= missing;
    rule.envelope.travelled_max -= missing;
  }
  expect_not_at_goal(plan);
}

TEST(EditedPlan, OneWithAnotherGoalIsNotDone) {
  Plan plan = box_plan("1");
  plan.goal.position_m.x() -= 0.6;
  expect_not_at_goal(plan);
}

}  // namespace
}  // namespace tenon::tests
