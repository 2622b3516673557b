// The page of a long run: small enough to be opened, and no peak lost on the way there.

#include "planner/report/run_page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "planner/report/run_data.h"
#include "tests/support/hand_made.h"

namespace tenon::planner {
namespace {

using nlohmann::json;

constexpr std::size_t kPageMax_bytes = 3'000'000;

/// Ten minutes at 500 Hz with six joints, noise on all that is measured.
RecordedRun long_run() {
  RecordedRun run;
  run.cell = "<b>cell</b>";
  run.robot = "robot";
  run.limits = {0.002, 60.0, 10.0, 0.85};
  for (int j = 0; j < 6; ++j)
    run.joints.push_back({"joint " + std::to_string(j), false, -3.0, 3.0});
  run.samples.resize(300'000);
  std::uint32_t noise = 1;
  const auto random = [&] {
    noise = noise * 1'664'525U + 1'013'904'223U;
    return static_cast<float>(noise >> 8U) * 1e-7F;
  };
  for (std::size_t i = 0; i < run.samples.size(); ++i) {
    RecordedCycle& sample = run.samples[i];
    sample.time_s = 0.002 * static_cast<double>(i);
    sample.step = i % 150'000 < 1000 ? -1 : static_cast<std::int16_t>(i / 150'000);
    sample.tool = {random(), random(), random(), 1.0F, 0.0F, 0.0F, 0.0F};
    sample.commanded = sample.tool;
    for (float& value : sample.wrench) value = random();
    for (float& value : sample.joints) value = random();
    for (float& value : sample.commanded_joints) value = random();
    sample.wakeup_late_s = 1e-4F * random();
    sample.compute_s = 1e-4F * random();
  }
  run.cycles = run.samples.size();
  run.duration_s = run.samples.back().time_s;
  return run;
}

double most(const json& row) {
  double value = 0.0;
  for (const json& one : row) value = std::max(value, one.is_null() ? 0.0 : one.get<double>());
  return value;
}

TEST(RunPage, OfTenMinutesIsSmallAndKeepsPeaksOfOneCycle) {
  const Plan plan = executor::touch_and_slide_plan();
  RecordedRun run = long_run();
  run.samples[123'457].wrench[2] = 31.25F;
  run.samples[222'222].wakeup_late_s = 0.0125F;
  run.samples[77'777].joints[4] = 2.75F;
  for (std::size_t i = 200'001; i < run.samples.size(); ++i) run.samples[i].late_cycles = 6;
  EXPECT_LT(run_report(plan, run, nullptr).size(), kPageMax_bytes);

  const json data = json::parse(run_json(plan, run, nullptr));
  const json& curves = data["run"]["curves"];
  EXPECT_EQ(curves["samples"], 300'000);
  EXPECT_EQ(most(curves["wrench"][2]), 31.25);
  EXPECT_NEAR(most(curves["wrench"][6]), std::hypot(31.25, 1.0), 1.0);
  EXPECT_NEAR(most(curves["wakeup_late_us"]), 12'500.0, 0.1);
  EXPECT_EQ(most(curves["joints"][4]["measured"]), 2.75);
  EXPECT_EQ(curves["times_s"].back(), 599.998);
  EXPECT_LE(curves["times_s"].size(), kMomentsMax);
  int late = 0;
  for (const json& count : curves["late_cycles"]) late += count.get<int>();
  EXPECT_EQ(late, 6);
  // From their first cycle to their last.
  ASSERT_EQ(data["run"]["spans"].size(), 2U);
  EXPECT_EQ(data["run"]["spans"][0]["from_s"], 2.0);
  EXPECT_EQ(data["run"]["spans"][0]["to_s"], 299.998);
  EXPECT_EQ(data["run"]["spans"][1]["from_s"], 302.0);
}

TEST(RunPage, EscapesWhatFilesSayAndNamesWhatIsMissing) {
  const Plan plan = executor::touch_and_slide_plan();
  RecordedRun run = long_run();
  run.samples.resize(100);
  run.notes = {"the log <ends>"};
  run.faults = {{0.1, "<script>"}};
  const std::string html = run_report(plan, run, nullptr);
  const std::string body = html.substr(0, html.find("<script type='application/json'"));
  EXPECT_EQ(body.find("<script>"), std::string::npos);
  EXPECT_EQ(body.find("<b>cell</b>"), std::string::npos);
  EXPECT_NE(body.find("the log &lt;ends&gt;"), std::string::npos);
  EXPECT_NE(body.find("Its end is not in the log"), std::string::npos);
  EXPECT_NE(body.find("give it with <code>--task</code>"), std::string::npos);
  run.samples.clear();
  EXPECT_NE(run_report(plan, run, nullptr).find("give it with <code>--log</code>"),
            std::string::npos);
}

// As tenon-exec says it at the run's end.
TEST(RunPage, CyclesWithFeedbackMissingAreSaidAndAreNothingGood) {
  const Plan plan = executor::touch_and_slide_plan();
  RecordedRun run;
  run.cycles = 1905;
  EXPECT_NE(run_report(plan, run, nullptr).find("<li class='good'>1905 cycles, 0 late; awake"),
            std::string::npos);
  run.incomplete_cycles = 916;
  EXPECT_NE(run_report(plan, run, nullptr)
                .find("<li class='bad'>1905 cycles, 0 late, 916 with feedback missing; awake"),
            std::string::npos);
}

// The run ended 10 mm beyond the goal along x, where the plan does not know where things are: it is
// the environment that was there. Along z, which it does know, nothing is moved.
TEST(RunPage, MovesAFinishedRunOntoTheGoalAlongThePlansCoordinates) {
  Plan plan = executor::touch_and_slide_plan();
  plan.coordinates = 0b000011;
  RecordedRun run;
  run.done = run.ended = true;
  RecordedStep last;
  last.step = plan.steps.size() - 1;
  last.successor = kSuccessorDone;
  last.tool = plan.goal;
  last.tool.position_m += Vector3(0.01, 0.0, 0.004);
  run.steps = {last};
  const json fit = json::parse(run_json(plan, run, nullptr))["run"]["fit"];
  EXPECT_EQ(fit, json::parse("[-0.01, 0, 0, 1, 0, 0, 0]"));
  run.done = false;
  EXPECT_TRUE(json::parse(run_json(plan, run, nullptr))["run"]["fit"].is_null());
}

}  // namespace
}  // namespace tenon::planner
