// The report on a plan, and its table of steps.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "planner/judge/plan_draft.h"
#include "planner/report/drops.h"
#include "planner/report/html_report.h"
#include "planner/report/inspection.h"
#include "planner/report/summary.h"
#include "tests/planner/room_plan.h"

namespace tenon::planner {
namespace {

TEST(Report, IsOneDocumentWithoutOutsideResources) {
  const Task task = room_task();
  const PlanReport report = planned(task);
  ASSERT_EQ(report.status, PlanStatus::kPlanned);
  const std::string html = html_report(*report.plan, task, report.certification, report.validation);
  EXPECT_EQ(html.rfind("<!DOCTYPE html>", 0), 0U);
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  // What the scripts ask for is seen in a browser: tests/pages.
  const std::string before_scripts = html.substr(0, html.find("<script"));
  for (const char* outside : {"http:", "https:", "src=", "href=", "url(", "@import"}) {
    EXPECT_EQ(before_scripts.find(outside), std::string::npos) << outside;
  }
  EXPECT_NE(html.find("the chain holds"), std::string::npos);
  EXPECT_NE(html.find("Seen from above"), std::string::npos);
  EXPECT_EQ(html.find("Seen from the side"), std::string::npos);
}

TEST(Report, SaysWhichContactSettlesEachDirection) {
  Task task = room_task();
  Shape wall;
  wall.name = "low";  // the double's name for whatever is touched at a low coordinate
  wall.size_m = Vector3::Constant(0.1);
  wall.pose.position_m = {-0.6, 0.0, 0.0};
  task.environment = {wall};
  const PlanReport report = planned(task);
  ASSERT_EQ(report.status, PlanStatus::kPlanned);
  const std::string html = html_report(*report.plan, task, report.certification, report.validation);
  EXPECT_NE(html.find("<li><b>x 42.4 mm &rarr; 0 mm</b>"), std::string::npos);
  EXPECT_NE(html.find("<li><b>y 42.4 mm &rarr; 0 mm</b>"), std::string::npos);
  EXPECT_NE(html.find(" mm: contact with low begins</li>"), std::string::npos);
}

TEST(Report, ShowsTheUncertaintyThatABaselineDoesNotKnow) {
  const Task task = room_task();
  PlannerOptions options;
  options.method = PlanMethod::kSingleParticle;
  const PlanReport report = planned(task, room(), options);
  ASSERT_EQ(report.status, PlanStatus::kPlanned);
  const std::string html = html_report(*report.plan, task, report.certification, report.validation);
  EXPECT_NE(html.find("baseline <b>single-particle</b>"), std::string::npos);
  EXPECT_NE(html.find("Root of u of the random starts"), std::string::npos);
  EXPECT_EQ(html.find("Why it works"), std::string::npos);
}

// Its one particle moves freely; the draws, whose uncertainty it is, are stopped by a wall.
TEST(Report, ABaselinesDropIsExplainedByTheDraws) {
  Task task = room_task();
  task.held = {{"part", Shape::Kind::kBox, Vector3::Constant(0.1), {}}};
  task.environment = {{"low", Shape::Kind::kBox, Vector3::Constant(0.1), {}}};
  const std::vector<Vector6> displacements = {Vector6::Unit(0) * -0.1};
  Plan plan = draft_plan(task, task.starts.front(), {}, displacements);
  plan.method = PlanMethod::kSingleParticle;
  Chain chain;
  chain.moves.resize(1);
  chain.steps = {0};
  chain.touching = {{}};
  chain.done = true;
  const std::vector<Chain> known = {chain};
  chain.touching = {{"part-low"}};
  Validation validation;
  validation.draws.resize(1);
  validation.draws.front().chain = chain;
  BeliefNode before;
  before.spread[0] = 0.04;
  const ReportData data{plan, task, known, true, validation, {before, BeliefNode{}}};
  const std::vector<Drop> drops = drops_in(data, 0);
  ASSERT_EQ(drops.size(), 1U);
  EXPECT_EQ(drops.front().why, "contact with low begins");
}

TEST(Report, WarnsOfAPlanThatMissesFromMoreThanAFewStarts) {
  Task task = room_task();
  const PlanReport report = planned(task);
  ASSERT_EQ(report.status, PlanStatus::kPlanned);
  Validation validation = report.validation;
  for (Draw& draw : validation.draws) {
    draw.sigmas_out = 1.0;
    draw.at_goal = true;
  }
  EXPECT_EQ(doubt_text(validation, task), "");
  for (std::size_t i = 0; i + 1 < validation.draws.size(); ++i) validation.draws[i].at_goal = false;
  const std::string one = "only 1 of " + std::to_string(validation.draws.size()) + " random starts";
  EXPECT_EQ(doubt_text(validation, task).rfind(one, 0), 0U) << doubt_text(validation, task);
  EXPECT_EQ(doubt_text(validation, task).find("degrees"), std::string::npos);

  task.tilt_rad = 3e-3;
  validation.held.tilt_rad = 0.0;
  EXPECT_NE(doubt_text(validation, task).find("0.17 degrees"), std::string::npos);
  const std::string html = html_report(*report.plan, task, report.certification, validation);
  EXPECT_NE(html.find(one), std::string::npos);
}

TEST(Report, TheStepTableNamesEveryStepAndItsEnd) {
  const PlanReport report = planned(room_task());
  const std::string table = step_table(*report.plan);
  EXPECT_NE(table.find("-> done"), std::string::npos);
  EXPECT_NE(table.find("contact"), std::string::npos);
  EXPECT_NE(plan_json(*report.plan, report.bytes.size()).find("\"successor\": \"done\""),
            std::string::npos);
}

}  // namespace
}  // namespace tenon::planner
