// What tenon-inspect and tenon-plan say about a plan.

#include "planner/report/inspection.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "planner/judge/plan_draft.h"
#include "planner/report/summary.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

Plan drafted() {
  const Task task = room_task();
  const std::vector<Vector6> ways = {0.1 * Vector6::Unit(0), 0.1 * Vector6::Unit(1)};
  return draft_plan(task, task.starts.front(), {}, ways);
}

TEST(Inspection, NamesCoordinatesAndCompliantAxesEachByThemselves) {
  const Plan plan = drafted();
  for (int again = 0; again < 2; ++again) {
    const std::string text = header_text(plan, 100);
    EXPECT_NE(text.find("coordinates x y\n"), std::string::npos) << text;
    EXPECT_NE(text.find("on x y; force"), std::string::npos) << text;
    const auto json = nlohmann::json::parse(plan_json(plan, 100));
    EXPECT_EQ(json["coordinates"], "x y");
    EXPECT_EQ(json["compliance"]["axes"], "x y");
  }
}

TEST(Inspection, SaysWhichMethodMadeThePlanAndWhatItChecks) {
  Plan plan = drafted();
  plan.method = PlanMethod::kContactGreedy;
  EXPECT_NE(header_text(plan, 100).find("method contact-greedy"), std::string::npos);
  EXPECT_NE(header_text(plan, 100).find("no envelopes are checked"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(plan_json(plan, 100))["method"], "contact-greedy");
  plan.method = PlanMethod::kMha;
  plan.check_envelopes = true;
  EXPECT_NE(header_text(plan, 100).find("method mha"), std::string::npos);
  EXPECT_EQ(header_text(plan, 100).find("no envelopes are checked"), std::string::npos);
}

TEST(Inspection, ABoundOfZeroIsNoBound) {
  Plan plan = drafted();
  plan.cost = 4500.0;
  EXPECT_EQ(cost_text(plan), "cost 4500, no bound proven\n");
  plan.bound = 1.25;
  EXPECT_EQ(cost_text(plan), "cost 4500, at most 1.25 times the optimum of the searched graph\n");
}

TEST(Inspection, OutcomesWithOneSuccessorAndNoEnvelopeShareALine) {
  const std::string table = step_table(drafted());
  EXPECT_NE(table.find("reached, contact, release, blocked -> 1\n"), std::string::npos) << table;
  EXPECT_NE(table.find("reached, contact, release, blocked -> done\n"), std::string::npos) << table;
}

}  // namespace
}  // namespace tenon::planner
