#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "shared/base/error.h"
#include "sim/evaluation/run_line.h"
#include "sim/evaluation/run_log.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon::sim {
namespace {

using Lines = std::vector<std::string>;

const std::string kIdentity = R"({"seed":1})";

Run run_with_awkward_numbers() {
  Run run;
  run.trial.number = 17;
  run.trial.seed = 9007199254740991;
  run.trial.offset << 0.1, -1.0 / 3.0, 5e-324, 1.7976931348623157e308, -0.0, 2e-10;
  run.trial.distance = 2.0000000000000004;
  run.result.ending = "plan_failed";
  run.result.reason = "step 3: \"contact\"\nwhere none was \\ \u03c3";
  run.result.step = 3;
  run.result.outcome = "contact";
  run.result.steps = 4;
  run.result.duration_s = 0.1 + 0.2;
  run.result.error = Vector6(1e-3 / 3.0 * Vector6::Ones());
  run.result.path_m = {{0.1 + 0.2, -1.0 / 3.0, 0.0}, {1e-6, 2.0, -3.25}};
  run.result.contact_force_N_max = 21.300000000000001;
  return run;
}

TEST(EvaluationRunLine, ComesBackBitForBit) {
  const sim::Run run = run_with_awkward_numbers();
  const std::string line = run_line("abc", run, true);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const auto record = parse_run_line(line);
  ASSERT_TRUE(record);
  EXPECT_EQ(record->plan, "abc");
  EXPECT_EQ(record->number, 17U);
  EXPECT_EQ(record->seed, 9007199254740991U);
  EXPECT_EQ(*record->result.error, *run.result.error);
  EXPECT_EQ(record->result.path_m, run.result.path_m);
  EXPECT_EQ(run_line("abc", {run.trial, record->result}, true), line);
}

TEST(EvaluationRunLine, ARunThatNeverWasHasNoError) {
  sim::Run run;
  run.result.ending = kNoWorld;
  const auto record = parse_run_line(run_line("abc", run, false));
  ASSERT_TRUE(record);
  EXPECT_FALSE(record->result.error);
}

TEST(EvaluationRunLine, WhatIsNoWholeLineIsNone) {
  const std::string line = run_line("abc", run_with_awkward_numbers(), false);
  for (std::size_t length = 0; length < line.size(); ++length) {
    EXPECT_FALSE(parse_run_line(line.substr(0, length))) << length;
  }
  EXPECT_FALSE(parse_run_line(R"({"plan":"abc","run":"17"})"));
}

TEST(EvaluationRunLog, HoldsWhatWasAppended) {
  const tests::ScratchFolder folder;
  const auto file = folder.path() / "runs.jsonl";
  {
    RunLog log(file, kIdentity);
    EXPECT_TRUE(log.found().empty());
    log.append("one");
  }
  {
    RunLog log(file, kIdentity);
    EXPECT_EQ(log.found(), Lines{"one"});
    log.append("two");
  }
  EXPECT_EQ(folder.get("runs.jsonl"), kIdentity + "\none\ntwo\n");
  EXPECT_EQ(read_run_log(file, kIdentity), (Lines{"one", "two"}));
}

TEST(EvaluationRunLog, TornAnywhereItKeepsTheWholeLinesAndGoesOn) {
  const std::string whole = kIdentity + "\none\ntwo\n";
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    const tests::ScratchFolder folder;
    const auto file = folder.put("runs.jsonl", whole.substr(0, length));
    Lines kept;
    if (length >= kIdentity.size() + 5) kept.push_back("one");
    if (length == whole.size()) kept.push_back("two");
    {
      RunLog log(file, kIdentity);
      EXPECT_EQ(log.found(), kept) << length;
      EXPECT_EQ(log.was_torn(), length > 0 && whole[length - 1] != '\n') << length;
      log.append("three");
    }
    kept.push_back("three");
    EXPECT_EQ(RunLog(file, kIdentity).found(), kept) << length;
  }
}

TEST(EvaluationRunLog, AnothersRunsAreRefusedAndLeftAlone) {
  const tests::ScratchFolder folder;
  const auto file = folder.put("runs.jsonl", "{\"seed\":2}\none\n");
  const std::string line = tests::refusal([&] { const RunLog log(file, kIdentity); });
  EXPECT_NE(line.find("another evaluation"), std::string::npos) << line;
  EXPECT_THROW(static_cast<void>(read_run_log(file, kIdentity)), InputError);
  EXPECT_EQ(folder.get("runs.jsonl"), "{\"seed\":2}\none\n");
}

TEST(EvaluationRunLog, ANoteWithoutALineEndIsNoTornLogAndLeftAlone) {
  const tests::ScratchFolder folder;
  const auto file = folder.put("runs.jsonl", "buy milk");
  const std::string line = tests::refusal([&] { const RunLog log(file, kIdentity); });
  EXPECT_NE(line.find("is no run log"), std::string::npos) << line;
  EXPECT_EQ(folder.get("runs.jsonl"), "buy milk");
}

TEST(EvaluationRunLog, HasOneWriter) {
  const tests::ScratchFolder folder;
  const auto file = folder.path() / "runs.jsonl";
  std::optional<RunLog> first;
  first.emplace(file, kIdentity);
  EXPECT_THROW(RunLog(file, kIdentity), InputError);
  first.reset();
  EXPECT_NO_THROW(RunLog(file, kIdentity));
}

TEST(EvaluationRunLog, WhatCannotBeOpenedIsNamed) {
  const tests::ScratchFolder folder;
  EXPECT_THROW(RunLog(folder.path() / "none/runs.jsonl", kIdentity), InputError);
  EXPECT_THROW(static_cast<void>(read_run_log(folder.path() / "none", kIdentity)), InputError);
  EXPECT_THROW(static_cast<void>(read_run_log(folder.put("empty", ""), kIdentity)), InputError);
}

}  // namespace
}  // namespace tenon::sim
