// The same bytes, however the runs came about. A function of plan and trial stands for the arm.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>

#include "shared/base/error.h"
#include "sim/evaluation/evaluation_json.h"
#include "sim/evaluation/run_maker.h"
#include "tests/sim/literal_cell.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon::sim {
namespace {

constexpr std::size_t kCount = 10;

Evaluation two_plans() {
  Evaluation evaluation;
  evaluation.task = wall_task();
  evaluation.seed = 5;
  evaluation.ranges.emplace().friction = Spread{.low = 0.1, .high = 0.6};
  for (const char* name : {"a", "b"}) {
    Candidate candidate;
    candidate.file = candidate.hash = name;
    candidate.start = evaluation.task.starts.front();
    candidate.start.sigma.head<2>() << 0.03, 0.02;
    evaluation.candidates.push_back(candidate);
  }
  return evaluation;
}

TrialResult of(std::size_t plan, const Trial& trial) {
  TrialResult result;
  result.done = trial.distance < 1.5;
  result.at_goal = result.done && plan == 0;
  result.ending = result.done ? "plan_done" : "plan_failed";
  result.error = Vector6(0.01 * trial.offset);
  result.contact_force_N_max = std::sqrt(trial.world.friction.value());
  return result;
}

RunMaker::Parameters parameters_with(const std::filesystem::path& log) {
  RunMaker::Parameters parameters;
  parameters.count = kCount;
  parameters.identity = "{}";
  parameters.log = log;
  return parameters;
}

/// The JSON, and in `made` how many runs it took.
std::string json_of(const RunMaker::Parameters& parameters, std::size_t& made) {
  Evaluation evaluation = two_plans();
  made = 0;
  RunMaker maker(evaluation, parameters);
  maker.make(of, [&](const sim::Run&) { ++made; });
  return evaluation_json(evaluation);
}

std::string json_of(const RunMaker::Parameters& parameters) {
  std::size_t made = 0;
  return json_of(parameters, made);
}

TEST(EvaluationRunMaker, ThreadsDoNotShowInTheResults) {
  const std::string whole = json_of(parameters_with({}));
  RunMaker::Parameters parameters = parameters_with({});
  parameters.threads = 4;
  EXPECT_EQ(json_of(parameters), whole);
}

TEST(EvaluationRunMaker, StoppedAnywhereItGoesOnToTheSameResults) {
  const std::string whole = json_of(parameters_with({}));
  for (std::size_t stop = 0; stop < 2 * kCount; stop += 3) {
    const tests::ScratchFolder folder;
    const auto parameters = parameters_with(folder.path() / "runs.jsonl");
    {
      Evaluation evaluation = two_plans();
      std::size_t begun = 0;
      RunMaker maker(evaluation, parameters);
      const auto until_stop = [&](std::size_t plan, const Trial& trial) {
        if (begun++ == stop) throw std::runtime_error("stop");
        return of(plan, trial);
      };
      EXPECT_THROW(maker.make(until_stop, [](const sim::Run&) {}), std::runtime_error);
    }
    std::ofstream(parameters.log, std::ios::app) << R"({"plan":"a")";  // torn
    std::size_t made = 0;
    EXPECT_EQ(json_of(parameters, made), whole) << stop;
    EXPECT_EQ(made, 2 * kCount - stop);
    EXPECT_EQ(json_of(parameters, made), whole);
    EXPECT_EQ(made, 0U);
  }
}

TEST(EvaluationRunMaker, MergedShardsAreTheWholeAndWhatTheyLackIsMade) {
  const std::string whole = json_of(parameters_with({}));
  const tests::ScratchFolder folder;
  std::size_t made = 0;
  for (std::size_t index = 0; index < 3; ++index) {
    auto shard = parameters_with(folder.path() / std::to_string(index));
    shard.shard = {index, 3};
    EXPECT_NE(json_of(shard, made), whole);
  }
  auto merged = parameters_with({});
  merged.others = {folder.path() / "2", folder.path() / "0", folder.path() / "1"};
  EXPECT_EQ(json_of(merged, made), whole);
  EXPECT_EQ(made, 0U);
  merged.others.pop_back();
  EXPECT_EQ(json_of(merged, made), whole);
  EXPECT_EQ(made, 6U);  // 1, 4 and 7 of both plans
}

TEST(EvaluationRunMaker, MoreRunsAddToThoseThatAreThere) {
  const tests::ScratchFolder folder;
  auto parameters = parameters_with(folder.path() / "runs.jsonl");
  const std::string ten = json_of(parameters);
  parameters.count = 14;
  std::size_t made = 0;
  EXPECT_NE(json_of(parameters, made), ten);
  EXPECT_EQ(made, 8U);
  parameters.count = kCount;
  EXPECT_EQ(json_of(parameters, made), ten);
  EXPECT_EQ(made, 0U);
}

void expect_refused(const std::string& log, const std::string& named) {
  const tests::ScratchFolder folder;
  const auto parameters = parameters_with(folder.put("runs.jsonl", log));
  const std::string line = tests::refusal([&] { static_cast<void>(json_of(parameters)); });
  EXPECT_NE(line.find(named), std::string::npos) << line;
}

TEST(EvaluationRunMaker, ALogThatIsDamagedOrContradictsTheSeedIsRefused) {
  expect_refused("{}\nrubbish\n", "runs.jsonl:2: is damaged");
  const Evaluation evaluation = two_plans();
  const Trial trial = evaluation.trial(0, 3);
  const std::string right = run_line("a", {trial, of(0, trial)}, true);
  Trial another = trial;
  another.offset[0] += 1e-9;
  expect_refused("{}\n" + run_line("a", {another, of(0, trial)}, true) + "\n",
                 "runs.jsonl:2: contradicts what the seed draws for run 3");
  TrialResult otherwise = of(0, trial);
  otherwise.steps = 9;
  expect_refused("{}\n" + right + "\n" + run_line("a", {trial, otherwise}, true) + "\n",
                 "runs.jsonl:3: contradicts what stands elsewhere about run 3");
}

TEST(EvaluationRunMaker, AShardIsOneOfN) {
  EXPECT_EQ(parse_shard("1/1").count, 1U);
  EXPECT_EQ(parse_shard("3/8").index, 2U);
  EXPECT_EQ(parse_shard("8/8").index, 7U);
  for (const char* text : {"", "1", "0/2", "3/2", "1/0", "a/b", "1/2x", "1/2/3", "-1/-1"}) {
    EXPECT_THROW(static_cast<void>(parse_shard(text)), InputError) << text;
  }
}

}  // namespace
}  // namespace tenon::sim
