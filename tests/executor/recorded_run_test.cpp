// A run read back from its log and its result: what it was, and every way in which they may not
// fit.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "executor/recorded/result_file.h"
#include "executor/recorded/run_log.h"
#include "executor/telemetry/recorder.h"
#include "executor/telemetry/run_result.h"
#include "executor/telemetry/telemetry.h"
#include "tests/executor/bench.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon::executor {
namespace {

using testing::HasSubstr;
using tests::refusal;

/// touch_and_slide_plan(), executed and written down.
class RecordedRunTest : public testing::Test {
 protected:
  void SetUp() override { run(0.13); }

  /// @param wall_m where the wall stands in truth
  void run(double wall_m) {
    const auto recorder = std::make_unique<Recorder>();
    Bench bench(plan, {}, hand_made_cell(), Vector3::Zero(), recorder.get());
    bench.arm.walls.push_back({0, +1, wall_m});
    std::vector<std::string> warnings;
    Telemetry telemetry(open_telemetry("none", log_file(), warnings), hand_made_cell(),
                        &bench.controller.runner(), *recorder);
    telemetry.publish_setup();
    recorder->add(telemetry);
    bench.run([&] { recorder->drain(); });
    recorder->drain();
    ran = gather_result(bench.controller, bench.runner, 0, "");
    telemetry.publish_summary(ran, bench.controller.record());
    (void)telemetry.close_log();
    log_bytes = folder.get("run.lcmlog");
    result_json = to_json(ran, hand_made_cell());
  }

  [[nodiscard]] std::string log_file() const { return folder.path() / "run.lcmlog"; }
  [[nodiscard]] RecordedRun read(const std::string& bytes) const {
    folder.put("run.lcmlog", bytes);
    return read_run_log(log_file(), plan);
  }
  [[nodiscard]] std::string result_with(const char* key, const nlohmann::json& value) const {
    nlohmann::json json = nlohmann::json::parse(result_json);
    json[nlohmann::json::json_pointer(key)] = value;
    return json.dump();
  }
  [[nodiscard]] std::string result_refusal(const std::string& text) const {
    return refusal([&] { (void)read_run_result("result.json", text, plan); });
  }

  Plan plan = touch_and_slide_plan();
  tests::ScratchFolder folder;
  RunResult ran;
  std::string log_bytes;
  std::string result_json;
};

TEST_F(RecordedRunTest, TheLogTellsAllCyclesStepsStatesAndTheEnd) {
  const RecordedRun run = read(log_bytes);
  EXPECT_TRUE(run.ended);
  EXPECT_TRUE(run.done);
  EXPECT_EQ(run.message, ran.message);
  EXPECT_EQ(run.samples.size(), ran.statistics.cycles);
  EXPECT_NEAR(run.duration_s, ran.duration_s, 0.0021);
  ASSERT_EQ(run.steps.size(), 2U);
  EXPECT_EQ(run.steps[0].outcome, Outcome::kContact);
  EXPECT_EQ(run.steps[0].signature, "-x");
  EXPECT_NEAR(run.steps[0].travelled[0], 0.03, 5e-4);
  EXPECT_EQ(run.steps[1].successor, kSuccessorDone);
  EXPECT_TRUE(run.faults.empty());
  EXPECT_TRUE(run.notes.empty());
  ASSERT_EQ(run.joints.size(), 3U);
  EXPECT_EQ(run.limits->cycle_s, 0.002);
  EXPECT_EQ(run.states.front().name, "waiting");
  EXPECT_EQ(run.states.back().name, "finished");
  double peak_N = 0.0;
  for (const RecordedCycle& cycle : run.samples) {
    if (cycle.step == 0) peak_N = std::max<double>(peak_N, std::abs(cycle.wrench[0]));
  }
  EXPECT_NEAR(peak_N, ran.steps[0].result.peak_force_N, 1e-3);
}

TEST_F(RecordedRunTest, AStepThatEndsOutsideItsEnvelopeSaysByHowMuchAsTheExecutorDid) {
  plan.steps[0].outcomes[1].envelope.travelled_min[0] = 0.035;
  run(0.13);
  const RecordedRun run = read(log_bytes);
  EXPECT_THAT(run.steps[0].deviation, HasSubstr("travelled 30.07 mm along x where validation saw"));
  EXPECT_THAT(ran.message, HasSubstr(run.steps[0].deviation));
}

TEST_F(RecordedRunTest, TheResultTellsTheSameSteps) {
  const RecordedRun result = read_run_result("result.json", result_json, plan);
  const RecordedRun log = read(log_bytes);
  ASSERT_EQ(result.steps.size(), 2U);
  EXPECT_EQ(result.steps[0].outcome, Outcome::kContact);
  EXPECT_EQ(result.cycles, log.cycles);
  EXPECT_TRUE(result.done);
  const RecordedRun both = joined(log, result, "run.lcmlog", "result.json");
  EXPECT_EQ(both.samples.size(), log.samples.size());
  EXPECT_EQ(both.peak_force_N, ran.peak_force_N);
}

TEST_F(RecordedRunTest, ALogOfAnotherPlanIsRefused) {
  const auto said = [&] { return refusal([&] { (void)read(log_bytes); }); };
  plan.start_name = "elsewhere";
  EXPECT_THAT(said(), HasSubstr("from start 'elsewhere'; give the plan that was executed"));
  plan = touch_and_slide_plan();
  plan.steps[0].displacement[0] += 0.001;
  EXPECT_THAT(said(), HasSubstr("of another plan of 'hand-made': step 0 goes another way"));
  plan = touch_and_slide_plan();
  plan.parameter_sets[0].thresholds.force_on_N += 1.0;
  EXPECT_THAT(said(), HasSubstr("step 0 has a contact from 6 N, the plan's from 7 N"));
  plan = touch_and_slide_plan();
  plan.steps.push_back(plan.steps.back());
  EXPECT_THAT(said(), HasSubstr("2 steps, the plan has 3"));
}

// As far as it goes, and it says so; where nothing of the run is left it is refused.
TEST_F(RecordedRunTest, ALogThatEndsEarlyIsReadAsFarAsItGoes) {
  std::size_t before = 0;
  std::size_t refused = 0;
  const auto cut = [&](std::size_t size) {
    const std::string bytes = log_bytes.substr(0, size);
    std::size_t cycles = 0;
    const std::string said = refusal([&] {
      const RecordedRun run = read(bytes);
      cycles = run.samples.size();
      EXPECT_FALSE(run.ended);
      ASSERT_FALSE(run.notes.empty());
      EXPECT_THAT(run.notes[0], testing::AnyOf(HasSubstr("breaks off within a message"),
                                               HasSubstr("ends before the run does")));
    });
    if (said != "accepted") {
      ++refused;
      EXPECT_THAT(said, testing::AnyOf(HasSubstr("is no LCM log"), HasSubstr("holds no cycle")));
    }
    EXPECT_GE(cycles, before) << size;
    before = cycles;
  };
  constexpr std::size_t kFirst = 2500;
  for (std::size_t size = 0; size < kFirst; ++size) cut(size);
  EXPECT_GT(refused, 100U);
  EXPECT_GT(before, 1U);
  for (std::size_t size = kFirst; size + 400 < log_bytes.size(); size += 29'989) cut(size);
  EXPECT_GT(before, ran.statistics.cycles / 2);
}

TEST_F(RecordedRunTest, ADamagedLogIsRefusedWithThePlace) {
  const std::string sync = "\xED\xA1\xDA\x01";
  const std::size_t at = log_bytes.find(sync, log_bytes.size() / 2);
  std::string bytes = log_bytes;
  bytes[at] = 'x';
  EXPECT_THAT(refusal([&] { (void)read(bytes); }),
              HasSubstr("byte " + std::to_string(at) + ": no event of an LCM log begins here"));
  EXPECT_THAT(refusal([&] { (void)read("time,force\n0,1\n"); }), HasSubstr("is no LCM log"));
  EXPECT_THAT(refusal([&] { (void)read_run_log(folder.path() / "none", plan); }),
              HasSubstr("cannot be read: No such file"));
  EXPECT_THAT(refusal([&] { (void)read_run_log(folder.path(), plan); }),
              HasSubstr("not a regular file"));
}

// Any byte of the messages may be another one.
TEST_F(RecordedRunTest, WhateverTheMessagesSayNothingWorseThanARefusalComesOfIt) {
  const std::string head = log_bytes.substr(0, 2500);
  for (std::size_t i = 4; i < head.size(); ++i) {
    std::string bytes = head;
    bytes[i] = static_cast<char>(bytes[i] ^ (1 << (i % 8)));
    (void)refusal([&] { EXPECT_LE(read(bytes).samples.size(), 20U); });
  }
}

TEST_F(RecordedRunTest, OfSeveralRunsTheLastIsRead) {
  const std::string first = log_bytes;
  run(0.128);
  const RecordedRun run = read(first + log_bytes);
  EXPECT_EQ(run.samples.size(), ran.statistics.cycles);
  ASSERT_EQ(run.steps.size(), 2U);
  EXPECT_NEAR(run.steps[0].travelled[0], 0.028, 5e-4);
  ASSERT_EQ(run.notes.size(), 1U);
  EXPECT_EQ(run.notes[0], "The log holds 2 runs; this is the last.");
}

TEST_F(RecordedRunTest, AResultOfAnotherRunThanTheLogIsRefused) {
  const std::string other = result_json;
  run(0.128);
  EXPECT_THAT(refusal([&] {
                (void)joined(read(log_bytes), read_run_result("result.json", other, plan),
                             "run.lcmlog", "result.json");
              }),
              HasSubstr("result.json: is of another run than run.lcmlog: its step 0"));
}

TEST_F(RecordedRunTest, AResultThatIsNoneOrOfAnotherPlanIsRefusedByKey) {
  EXPECT_EQ(result_refusal(result_json), "accepted");
  EXPECT_THAT(result_refusal("{\"task\": "), HasSubstr("is no whole JSON"));
  EXPECT_THAT(result_refusal("[]"), HasSubstr("must be an object"));
  EXPECT_THAT(result_refusal("{}"), HasSubstr("is missing; give the file that tenon-exec wrote"));
  EXPECT_THAT(result_refusal(result_with("/task", "other")), HasSubstr("is of a plan of 'other'"));
  EXPECT_THAT(result_refusal(result_with("/task", "")), HasSubstr("of an identification"));
  EXPECT_THAT(result_refusal(result_with("/steps/1/step", 7)),
              HasSubstr("steps[1].step = 7, the plan has 2 steps"));
  EXPECT_THAT(result_refusal(result_with("/steps/0/outcome", "won")),
              HasSubstr("steps[0].outcome = won is no outcome"));
  EXPECT_THAT(result_refusal(result_with("/steps/0/next", 5)), HasSubstr("of another plan"));
  EXPECT_THAT(result_refusal(result_with("/steps/0/travelled", {1, 2})),
              HasSubstr("steps[0].travelled must have 6 numbers"));
  EXPECT_THAT(result_refusal(result_with("/duration_s", "long")),
              HasSubstr("duration_s must be a number"));
  EXPECT_THAT(result_refusal(result_with("/cycle/late_cycles", -1)),
              HasSubstr("cycle.late_cycles must be a count"));
  // Each a number, all of them of no length.
  EXPECT_THAT(result_refusal(result_with("/steps/0/orientation_wxyz", {1e200, 0, 0, 1e200})),
              HasSubstr("orientation_wxyz must be a unit quaternion"));
  EXPECT_THAT(result_refusal(result_with("/steps/0/position_m", {0.1, -1.7e308, 0.0})),
              HasSubstr("steps[0].position_m is where no tool can be"));
}

}  // namespace
}  // namespace tenon::executor
