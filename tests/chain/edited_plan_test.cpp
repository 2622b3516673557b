// A plan that was changed since it was made is not done where it ends: its goal tells, before
// anything moves and at the end.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

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

// The table may be off by 0.09 m to each side, and every touch adds to what the envelopes leave
// open: only what the longest step goes is more than that.
std::vector<Step>::iterator longest_step(Plan& plan) {
  return std::max_element(plan.steps.begin(), plan.steps.end(), [](const Step& a, const Step& b) {
    return a.displacement.norm() < b.displacement.norm();
  });
}

TEST(EditedPlan, OneThatEndsTooSoonIsNotDone) {
  Plan plan = box_plan("1");
  const auto longest = longest_step(plan);
  ASSERT_NE(longest, plan.steps.begin());
  plan.steps.erase(longest, plan.steps.end());
  for (OutcomeRule& rule : plan.steps.back().outcomes) {
    if (rule.successor != kSuccessorFail) rule.successor = kSuccessorDone;
  }
  expect_not_at_goal(plan);
}

TEST(EditedPlan, OneWhoseLongestStepIsShorterIsNotDone) {
  Plan plan = box_plan("1");
  Step& longest = *longest_step(plan);
  const Vector6 missing = 0.95 * longest.displacement;
  longest.displacement -= missing;
  for (OutcomeRule& rule : longest.outcomes) {
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

// Where the plan goes nowhere, its goal is where it starts.
TEST(EditedPlan, OneWhoseGoalIsBesideItsCoordinatesIsNotDone) {
  Plan raised = box_plan("1");
  ASSERT_FALSE(has(raised.coordinates, 2));
  raised.goal.position_m.z() += 0.048;
  expect_not_at_goal(raised);
  Plan turned = box_plan("1");
  turned.goal.orientation =
      turned.goal.orientation * Eigen::Quaterniond(Eigen::AngleAxisd(0.1, Vector3::UnitZ()));
  EXPECT_FALSE(executor::check_plan(turned, gantry_cell()).empty());
}

// What its steps may come to, nobody could say.
TEST(EditedPlan, OneWithoutItsEnvelopesIsNotStarted) {
  Plan plan = box_plan("1");
  plan.check_envelopes = plan.check_places = false;
  plan.steps.back().displacement *= -1.0;
  const auto refusals = executor::check_plan(plan, gantry_cell());
  ASSERT_FALSE(refusals.empty());
  EXPECT_NE(refusals.front().find("no envelopes"), std::string::npos) << refusals.front();
}

}  // namespace
}  // namespace tenon::tests
