// What an evaluation's runs come to, in numbers and on the page.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "sim/evaluation/evaluation_html.h"
#include "sim/evaluation/evaluation_json.h"
#include "sim/evaluation/evaluation_junit.h"
#include "sim/evaluation/evaluation_page_data.h"
#include "sim/evaluation/figure_files.h"
#include "sim/evaluation/outline.h"
#include "sim/evaluation/summary.h"
#include "tests/sim/literal_cell.h"

namespace tenon::sim {
namespace {

Run run_of(std::size_t number, double offset_x_m, double error_x_m, bool done, bool at_goal) {
  Run run;
  run.trial.number = number;
  run.trial.offset[0] = offset_x_m;
  run.trial.distance = std::abs(offset_x_m) / 0.01;
  run.trial.world.friction = 0.1 * static_cast<double>(number);
  run.result.done = done;
  run.result.at_goal = at_goal;
  run.result.ending = done ? "plan_done" : "plan_failed";
  run.result.reason = done ? "done" : "step 1: <contact> where none was";
  run.result.error = Vector6(error_x_m * Vector6::Unit(0));
  run.result.contact_force_N_max = 10.0 * static_cast<double>(number);
  run.result.duration_s = 5.0;
  return run;
}

/// Runs 1 to 6: three succeed, one is wrong, one stops, one has no world.
Evaluation small_evaluation() {
  Evaluation evaluation;
  evaluation.task = wall_task();
  evaluation.task.name = "a & b";
  evaluation.cell.name = "test";
  evaluation.seed = 3;
  evaluation.replay = "tenon-evaluate --cell C --task 'T' --seed 3";
  Candidate candidate;
  candidate.file = "plans/p.tnp";
  candidate.start = evaluation.task.starts.front();
  candidate.start.sigma.head<2>() << 0.01, 0.01;
  candidate.plan.steps.resize(2);
  candidate.plan.parameter_sets.resize(1);
  candidate.runs.emplace(5, run_of(5, 0.035, 0.1, false, false));
  candidate.runs.emplace(1, run_of(1, 0.01, 1e-4, true, true));
  candidate.runs.emplace(2, run_of(2, -0.01, 3e-4, true, true));
  candidate.runs.emplace(4, run_of(4, 0.025, 0.03, true, false));
  candidate.runs.emplace(3, run_of(3, 0.0, 2e-4, true, true));
  Run none = run_of(6, 0.08, 0.0, false, false);
  none.result.ending = kNoWorld;
  none.result.error.reset();
  candidate.runs.emplace(6, none);
  evaluation.candidates.push_back(candidate);
  return evaluation;
}

TEST(EvaluationSummary, CountsEveryRunOnce) {
  const Evaluation evaluation = small_evaluation();
  const Summary summary = summarise(evaluation.task, evaluation.candidates[0]);
  EXPECT_EQ(summary.success.successes, 3U);
  EXPECT_EQ(summary.success.count, 6U);
  EXPECT_EQ(summary.stopped, 2U);
  EXPECT_EQ(summary.done_but_wrong, 1U);
  EXPECT_EQ(summary.endings.at("plan_done"), 4U);
  EXPECT_EQ(summary.endings.at("plan_failed"), 1U);
  EXPECT_EQ(summary.endings.at(kNoWorld), 1U);
  ASSERT_EQ(summary.within.size(), 2U);
  EXPECT_EQ(summary.within[0].rate.count, 3U);
  EXPECT_EQ(summary.within[1].rate.count, 4U);
  EXPECT_EQ(summary.within[1].rate.successes, 3U);
  EXPECT_NEAR(summary.within[1].mass, 0.988891, 1e-6);
}

TEST(EvaluationSummary, WhereNoRunWasDoneThereIsNoEndToTellOf) {
  Evaluation evaluation = small_evaluation();
  Candidate& candidate = evaluation.candidates.front();
  for (const std::size_t number : {1, 2, 3, 4}) candidate.runs.erase(number);
  const std::string stopped = describe(evaluation);
  EXPECT_NE(stopped.find("  no run was done"), std::string::npos) << stopped;
  EXPECT_EQ(stopped.find("off by"), std::string::npos) << stopped;
  EXPECT_EQ(stopped.find("distance from the goal"), std::string::npos) << stopped;
  EXPECT_NE(stopped.find("largest contact force: p50 50.0"), std::string::npos) << stopped;
  const std::string page = evaluation_html(evaluation);
  EXPECT_NE(page.find(">no run was done</td>"), std::string::npos);
  EXPECT_EQ(page.find("0.000 mm"), std::string::npos);
  EXPECT_EQ(page.find("0.00 / 0.00 mm"), std::string::npos);
  EXPECT_NE(page.find("50.0 / 50.0 / 50.0 N"), std::string::npos);
  candidate.runs.erase(5);
  EXPECT_EQ(describe(evaluation).find("contact force"), std::string::npos);
  EXPECT_EQ(evaluation_html(evaluation).find("0.0 / 0.0 / 0.0 N"), std::string::npos);
}

TEST(EvaluationSummary, APlanOfAnotherTaskIsSaidToBeOne) {
  Evaluation evaluation = small_evaluation();
  evaluation.candidates.front().plan.task_hash = evaluation.task.hash;
  EXPECT_EQ(describe(evaluation).find(kOtherTask), std::string::npos);
  ++evaluation.candidates.front().plan.task_hash;
  EXPECT_NE(describe(evaluation).find(kOtherTask), std::string::npos);
}

TEST(EvaluationSummary, AFailureInAWorldThatIsTiltedTooFarBreaksNoPromise) {
  Evaluation evaluation = small_evaluation();
  evaluation.task.particle_sigmas = 3.0;
  evaluation.task.tilt_rad = 3e-3;
  EXPECT_EQ(summarise(evaluation.task, evaluation.candidates[0]).promised.count, 4U);
  EXPECT_EQ(describe(evaluation).find("tilted"), std::string::npos);  // no world is

  evaluation.candidates[0].runs.at(4).trial.tilt_rad = 4e-3;  // done but wrong
  evaluation.candidates[0].runs.at(1).trial.tilt_rad = 2e-3;
  const Summary summary = summarise(evaluation.task, evaluation.candidates[0]);
  EXPECT_EQ(summary.within.back().rate.count, 4U);
  EXPECT_EQ(summary.promised.count, 3U);
  EXPECT_EQ(summary.promised.successes, 3U);
  EXPECT_EQ(summary.done_but_wrong, 1U);
  const std::string text = describe(evaluation);
  EXPECT_NE(text.find("of these tilted by at most 0.17 degrees, as the task has it: 3 of 3 ="),
            std::string::npos);
  EXPECT_NE(text.find("run 4, 2.50 sigma out, tilted by 0.23 degrees, done_but_wrong"),
            std::string::npos);
  const auto json = nlohmann::json::parse(evaluation_json(evaluation));
  EXPECT_EQ(json["plans"][0]["summary"]["promised"]["runs"], 3);
  EXPECT_NE(evaluation_html(evaluation).find("And tilted &le; 0.17&deg;"), std::string::npos);
}

TEST(EvaluationSummary, ErrorsAreThoseOfRunsThatWereDone) {
  const Evaluation evaluation = small_evaluation();
  const Summary summary = summarise(evaluation.task, evaluation.candidates[0]);
  ASSERT_EQ(summary.errors.size(), 2U);
  // 0.1, 0.3, 0.2 and 30 mm; offsets 10, -10, 0 and 25 mm.
  EXPECT_NEAR(summary.errors[0].final.mean, 7.65e-3, 1e-9);
  EXPECT_NEAR(summary.errors[0].final.deviation, 14.900223e-3, 1e-8);
  EXPECT_NEAR(summary.errors[0].initial.deviation, 14.930394e-3, 1e-8);
  EXPECT_NEAR(summary.errors[0].ratio(), 14.900223 / 14.930394, 1e-6);
  EXPECT_EQ(summary.errors[1].ratio(), 0.0);
  EXPECT_EQ(summary.contact_force_N.max, 50.0);  // the run without a world has none
  EXPECT_EQ(summary.contact_force_N.p50, 30.0);
}

TEST(EvaluationSummary, OneRunIsOneRunAndHasNoDeviation) {
  Evaluation evaluation = small_evaluation();
  auto& runs = evaluation.candidates[0].runs;
  runs.erase(std::next(runs.begin()), runs.end());
  const std::string text = describe(evaluation);
  EXPECT_NE(text.find("x: off by 10.000 at first, then 0.100 mm\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("deviation"), std::string::npos) << text;
  const std::string html = evaluation_html(evaluation);
  EXPECT_NE(html.find(">1 run, seed"), std::string::npos);
  EXPECT_EQ(html.find("0.0000 mm"), std::string::npos);
  // Of two that began alike no ratio can be told.
  const std::string several = describe(small_evaluation());
  EXPECT_EQ(several.find("()"), std::string::npos) << several;
}

TEST(EvaluationSummary, ABreakdownPutsEachRunInItsCell) {
  Evaluation evaluation = small_evaluation();
  evaluation.by = {parse_bins("friction=0.05:0.65:3"), parse_bins("distance=0:4:2")};
  const auto rates = break_down(evaluation.by, evaluation.candidates[0]);
  ASSERT_EQ(rates.size(), 2U);
  EXPECT_EQ(rates[0][0].successes, 2U);  // runs 1 and 2
  EXPECT_EQ(rates[0][1].count, 1U);      // run 3
  EXPECT_EQ(rates[1][1].count, 1U);      // run 4
  EXPECT_EQ(rates[1][1].successes, 0U);
  EXPECT_EQ(rates[1][2].count, 1U);  // run 5; run 6 is 8 sigma out
}

TEST(EvaluationSummary, TheWorstFailuresComeFirstEachWithItsCommand) {
  const Evaluation evaluation = small_evaluation();
  const auto failed = failures(evaluation.candidates[0]);
  ASSERT_EQ(failed.size(), 3U);
  EXPECT_EQ(failed[0]->trial.number, 4U);
  EXPECT_EQ(failed[1]->trial.number, 5U);
  EXPECT_NE(describe(evaluation)
                .find("tenon-evaluate --cell C --task 'T' --seed 3 --plan "
                      "plans/p.tnp --only 4\n"),
            std::string::npos);
}

TEST(EvaluationSummary, FailuresOfAKindAreCountedTogetherTheMostFrequentStopFirst) {
  Evaluation evaluation = small_evaluation();
  auto& runs = evaluation.candidates[0].runs;
  runs.emplace(7, run_of(7, 0.0, 0.1, false, false));
  runs.emplace(8, run_of(8, 0.0, 0.1, false, false));
  runs.at(8).result.step = 1;  // elsewhere
  const auto kinds = kinds_of_failure(evaluation.candidates[0]);
  ASSERT_EQ(kinds.size(), 4U);
  EXPECT_EQ(kinds[0].first().trial.number, 4U);  // done but wrong
  EXPECT_EQ(kinds[1].first().trial.number, 5U);
  EXPECT_EQ(kinds[1].count, 2U);  // 5 and 7
  EXPECT_EQ(kinds[2].first().trial.number, 6U);
  EXPECT_EQ(kinds[3].first().trial.number, 8U);
}

TEST(EvaluationJson, HoldsTheSummaryAndEveryRunInOrder) {
  const auto json = nlohmann::json::parse(evaluation_json(small_evaluation()));
  const auto& plan = json["plans"][0];
  EXPECT_EQ(plan["summary"]["success"]["succeeded"], 3);
  EXPECT_NEAR(plan["summary"]["success"]["wilson95_low"].get<double>(), 0.1876, 1e-4);
  ASSERT_EQ(plan["runs"].size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(plan["runs"][i]["run"], i + 1);
  EXPECT_EQ(plan["runs"][3]["class"], "done_but_wrong");
  EXPECT_TRUE(plan["runs"][5]["error"].is_null());
}

TEST(EvaluationJson, TheSummaryAloneCountsFailuresAndHoldsNoRun) {
  const auto json = nlohmann::json::parse(summary_json(small_evaluation()));
  const auto& plan = json["plans"][0];
  EXPECT_FALSE(plan.contains("runs"));
  ASSERT_EQ(plan["failures"].size(), 3U);
  EXPECT_EQ(plan["failures"][0]["class"], "done_but_wrong");
  EXPECT_EQ(plan["failures"][0]["first_run"], 4);
  EXPECT_EQ(plan["failures"][1]["ending"], "plan_failed");
  EXPECT_EQ(plan["failures"][1]["runs"], 1);
}

std::size_t count_of(const std::string& text, const std::string& piece) {
  std::size_t count = 0;
  for (std::size_t at = text.find(piece); at != std::string::npos; at = text.find(piece, at + 1)) {
    ++count;
  }
  return count;
}

TEST(EvaluationJunit, AWorldThatCannotBeIsAnErrorAndNoFailure) {
  const std::string xml = evaluation_junit(small_evaluation(), {});
  EXPECT_EQ(count_of(xml, "<testcase "), 6U);
  EXPECT_EQ(count_of(xml, "<failure "), 2U);
  EXPECT_EQ(count_of(xml, "<error "), 1U);
  EXPECT_EQ(count_of(xml, " tests='6' failures='2' errors='1'"), 2U);  // of the suite, of all
  EXPECT_NE(xml.find("type='done_but_wrong'"), std::string::npos);
  EXPECT_NE(xml.find("step 1: &lt;contact&gt; where none was"), std::string::npos);
}

TEST(EvaluationJunit, OnlyASuiteThatReachesItsBoundSkipsWhatFailed) {
  EXPECT_EQ(count_of(evaluation_junit(small_evaluation(), 0.5), "<skipped "), 3U);
  EXPECT_EQ(count_of(evaluation_junit(small_evaluation(), 0.51), "<skipped "), 0U);
  EXPECT_EQ(shortfall(small_evaluation(), 0.5), "");
  EXPECT_EQ(shortfall(small_evaluation(), 0.51),
            "plans/p.tnp: 3 of 6 runs succeeded, which is 0.5 and less than 0.51");
}

// A bound of 25 mm, which the runs that failed were beyond.
TEST(EvaluationSummary, UniformErrorsAreToldInPartsOfTheirBounds) {
  Evaluation evaluation = small_evaluation();
  evaluation.task.errors = Distribution::kUniform;
  evaluation.task.particle_sigmas = 2.0;
  EXPECT_NE(describe(evaluation).find("run 4, at 125 % of the bounds, done_but_wrong"),
            std::string::npos);
  const std::string page = evaluation_html(evaluation);
  EXPECT_EQ(count_of(page, "<title>run 4, at 125 % of the bounds"), 3U);
  EXPECT_NE(page.find("Square: the bounds."), std::string::npos);
  for (const char* other : {"sigma", "&sigma;", "standard deviations"}) {
    EXPECT_EQ(page.substr(0, page.find("<script")).find(other), std::string::npos) << other;
  }
  EXPECT_NE(evaluation_junit(evaluation, {}).find("at 125 % of the bounds"), std::string::npos);
}

TEST(EvaluationHtml, StandsAloneAndMarksEveryFailure) {
  Evaluation evaluation = small_evaluation();
  evaluation.by = {parse_bins("friction=0.05:0.65:3"), parse_bins("distance=0:4:2")};
  const std::string page = evaluation_html(evaluation);
  EXPECT_EQ(page.find(" src="), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  EXPECT_NE(page.find("a &amp; b"), std::string::npos);
  EXPECT_EQ(page.find("<contact>"), std::string::npos);
  EXPECT_NE(page.find("--only 4</code>"), std::string::npos);
  EXPECT_NE(page.find(".frame{fill:none"), std::string::npos);
  EXPECT_NE(page.find("(98.89 % of draws)"), std::string::npos);
  // A cross in each of the three figures of places, with what happened.
  EXPECT_EQ(count_of(page, "<title>run 4, 2.50 sigma"), 3U);
  EXPECT_EQ(count_of(page, "<title>run 5, 3.50 sigma"), 3U);
  EXPECT_EQ(count_of(page, "<title>run 6"), 1U);  // it ended nowhere
}

TEST(EvaluationHtml, SaysWhichEndsAPlotLeavesOutAndWhichItShowsAsIfAtTheGoal) {
  Evaluation evaluation = small_evaluation();
  EXPECT_NE(evaluation_html(evaluation)
                .find("Outside of this plot: 2 of 5 ends, 2 of them failed. 1 run ended nowhere."),
            std::string::npos);
  evaluation.task.coordinates = 0b000111;
  // Along z alone, which only the second side shows.
  evaluation.candidates[0].runs.at(4).result.error = Vector6(0.03 * Vector6::Unit(2));
  const std::string page = evaluation_html(evaluation);
  EXPECT_EQ(count_of(page, "Of the crosses, 1 in the circle: stopped, or off in what this side"),
            1U);
  EXPECT_EQ(count_of(page, "Outside of this plot: 1 of 5 ends, 1 of them failed."), 1U);
  EXPECT_EQ(count_of(page, "Outside of this plot: 2 of 5 ends, 2 of them failed."), 1U);
}

TEST(EvaluationPageData, TellsRunsApartByOutcomeAndReach) {
  Evaluation evaluation = small_evaluation();
  evaluation.task.particle_sigmas = 3.0;
  Candidate& candidate = evaluation.candidates[0];
  candidate.runs.at(5).result.path_m = {{0.0, 0.0, 0.1}, {0.0123456, 0.0, 0.1}};
  candidate.recordings[5].feel(Vector6::Constant(1.23456));
  candidate.recordings[5].add({});
  const auto json = nlohmann::json::parse(evaluation_page_json(evaluation, {candidate}));
  EXPECT_EQ(json["outcomes"].size(), 4U);
  EXPECT_EQ(json["outcomes"][2]["name"], std::string("stopped: ") + kNoWorld);
  const auto& plan = json["plans"][0];
  EXPECT_EQ(plan["counts"], nlohmann::json({3, 1, 1, 1}));
  EXPECT_EQ(plan["beyond"], 2);
  ASSERT_EQ(plan["runs"].size(), 1U);  // the others have no path
  EXPECT_EQ(plan["runs"][0]["outcome"], 3);
  EXPECT_EQ(plan["runs"][0]["beyond"], true);
  EXPECT_EQ(plan["runs"][0]["path"][3], 0.01235);
  EXPECT_EQ(plan["recordings"][0]["wrench"][2][0], 1.23);
}

/// Ten thousand runs of which three in four fail, each after twelve steps.
TEST(EvaluationHtml, OfTenThousandRunsItStaysBelowThreeMegabytes) {
  Evaluation evaluation = small_evaluation();
  evaluation.task.coordinates = 0b000111;
  Candidate& candidate = evaluation.candidates[0];
  for (std::size_t number = 7; number < 10'000; ++number) {
    const bool good = number % 4 == 0;
    sim::Run run = run_of(number, 0.0123456, 0.0234567, good, good);
    run.result.reason = std::string(250, 'x');
    run.result.path_m.assign(13, Vector3(0.123456, -0.123456, 0.123456));
    candidate.runs.emplace(number, std::move(run));
  }
  for (std::size_t i = 0; i < kReplaysMax; ++i) {
    Recording& recording = candidate.recordings[100 + i];
    for (std::size_t k = 0; k < Recording::kMomentsMax; ++k) {
      Moment moment;
      moment.time_ns = static_cast<std::int64_t>(k) * 31'000'000;
      moment.tool.position_m.setConstant(-0.123456);
      moment.tool.orientation.coeffs().setConstant(-0.123456);
      recording.feel(Vector6::Constant(-12.3456));
      recording.add(std::move(moment));
    }
  }
  const std::string page = evaluation_html(evaluation);
  constexpr std::size_t kOfMeshes = 500'000;  // that another task's shapes may take
  EXPECT_LT(page.size(), 3'000'000U - kOfMeshes);
  EXPECT_NE(page.find("7498 runs that failed"), std::string::npos);
  EXPECT_NE(page.find(" 600 of 9999 runs."), std::string::npos);
}

TEST(EvaluationFigures, EachIsAnSvgDocumentOfItsOwn) {
  Evaluation evaluation = small_evaluation();
  evaluation.by = {parse_bins("friction=0.05:0.65:3")};
  const auto files = figure_files(evaluation);
  std::string names;
  for (const FigureFile& file : files) names += file.name + " ";
  EXPECT_EQ(names, "p_runs.svg p_draws.svg p_ends.svg p_errors.svg p_by.svg ");
  for (const FigureFile& file : files) {
    EXPECT_EQ(file.svg.rfind("<svg xmlns='http://www.w3.org/2000/svg' width=", 0), 0U);
    EXPECT_EQ(count_of(file.svg, "<svg"), count_of(file.svg, "</svg>"));
    EXPECT_EQ(count_of(file.svg, "<style>"), 1U);
    EXPECT_EQ(file.svg.find("<title>"), std::string::npos);
  }
}

TEST(EvaluationFigures, ATaskInSpaceHasThemFromTwoSides) {
  Evaluation evaluation = small_evaluation();
  evaluation.task.coordinates = 0b000111;
  std::string names;
  for (const FigureFile& file : figure_files(evaluation)) names += file.name + " ";
  EXPECT_EQ(names,
            "p_runs_xy.svg p_draws_xy.svg p_ends_xy.svg p_runs_xz.svg p_draws_xz.svg p_ends_xz.svg "
            "p_errors.svg ");
}

TEST(EvaluationOutline, ABoxTurnedByAnEighthShowsItsDiagonal) {
  Shape box{"box", Shape::Kind::kBox, {0.2, 0.2, 0.1}, {}};
  Pose turned;
  turned.orientation = Eigen::AngleAxisd(0.25 * 3.14159265358979, Vector3::UnitZ());
  double right_mm = 0.0;
  for (const drawing::Point& point : outline(box, turned, drawing::View{}))
    right_mm = std::max(right_mm, point.x());
  EXPECT_NEAR(right_mm, 141.42136, 1e-4);
  EXPECT_EQ(outline(box, turned, drawing::View{}).size(), 4U);
  // From the front it is 282.8 mm wide and 100 mm high.
  const auto front = outline(box, turned, drawing::View{0, 2, 1});
  double up_mm = 0.0;
  for (const drawing::Point& point : front) up_mm = std::max(up_mm, point.y());
  EXPECT_NEAR(up_mm, 50.0, 1e-6);
}

}  // namespace
}  // namespace tenon::sim
