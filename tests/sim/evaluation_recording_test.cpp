// What a page replays: a run's moments, and which runs are kept.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/evaluation/recording.h"
#include "sim/evaluation/run_sample.h"
#include "sim/evaluation/summary.h"

namespace tenon::sim {
namespace {

constexpr std::int64_t kCycle_ns = 4'000'000;

/// One cycle after the other, each with its own place and force.
Recording recording_of(std::size_t cycles, const std::vector<double>& forces_N) {
  Recording recording;
  for (std::size_t i = 0; i < cycles; ++i) {
    recording.feel(Vector6(forces_N[i] * Vector6::Unit(1)));
    const std::int64_t time_ns = kCycle_ns * static_cast<std::int64_t>(i);
    if (!recording.is_due(time_ns)) continue;
    Moment moment;
    moment.time_ns = time_ns;
    moment.tool.position_m.x() = static_cast<double>(i);
    recording.add(std::move(moment));
  }
  return recording;
}

TEST(EvaluationRecording, AnyRunFitsAndNoPeakIsLost) {
  for (const std::size_t cycles : {1U, 7U, 1000U, 2001U, 2006U, 30'000U}) {
    std::vector<double> forces_N(cycles);
    for (std::size_t i = 0; i < cycles; ++i) forces_N[i] = std::sin(0.37 * static_cast<double>(i));
    forces_N[cycles / 3] = -40.0;
    const std::vector<Moment> moments = recording_of(cycles, forces_N).moments();
    ASSERT_FALSE(moments.empty());
    EXPECT_LE(moments.size(), Recording::kMomentsMax);
    EXPECT_EQ(moments.front().time_ns, 0);
    EXPECT_GE(moments.back().time_ns * 21 / 20 + 200'000'000,
              kCycle_ns * static_cast<std::int64_t>(cycles - 1));
    // By hand: the largest of the cycles since the last moment.
    std::size_t from = 0;
    for (std::size_t k = 0; k < moments.size(); ++k) {
      const auto last = static_cast<std::size_t>(moments[k].time_ns / kCycle_ns);
      EXPECT_EQ(moments[k].tool.position_m.x(), static_cast<double>(last));
      double wanted_N = 0.0;
      for (std::size_t i = from; i <= last; ++i) {
        if (std::abs(forces_N[i]) > std::abs(wanted_N)) wanted_N = forces_N[i];
      }
      EXPECT_EQ(moments[k].wrench[1], wanted_N) << cycles << " cycles, moment " << k;
      from = last + 1;
    }
  }
}

Candidate candidate_of(std::size_t count, std::size_t each_nth_fails) {
  Candidate candidate;
  for (std::size_t number = 0; number < count; ++number) {
    Run run;
    run.trial.number = number;
    run.result.done = run.result.at_goal = number % each_nth_fails != 0;
    run.result.ending = run.result.done ? "plan_done" : "plan_failed";
    run.result.step = static_cast<int>(number / each_nth_fails % 2);
    candidate.runs.emplace(number, run);
  }
  return candidate;
}

std::size_t failed_in(const Candidate& candidate) {
  return static_cast<std::size_t>(std::count_if(
      candidate.runs.begin(), candidate.runs.end(),
      [](const auto& entry) { return classify(entry.second.result) != TrialClass::kSucceeded; }));
}

TEST(EvaluationExamples, ThreeOfEachKindInTurnAndOneThatSucceeded) {
  const Candidate candidate = candidate_of(100, 10);
  std::vector<std::size_t> numbers;
  for (const auto* run : examples(candidate, 24)) numbers.push_back(run->trial.number);
  // Failures of step 0: 0, 20, 40 ..., of step 1: 10, 30, 50 ...
  EXPECT_EQ(numbers, (std::vector<std::size_t>{1, 0, 10, 20, 30, 40, 50}));
  EXPECT_EQ(examples(candidate, 4).size(), 4U);
}

TEST(EvaluationSample, AFewRunsAreLeftAloneAndManyBecomeAnEvenChoice) {
  EXPECT_EQ(sample_of(candidate_of(100, 10), 100).runs.size(), 100U);
  Candidate many = candidate_of(10'000, 10);
  many.recordings.emplace(7, Recording{});
  const Candidate sample = sample_of(many, 300);
  EXPECT_EQ(sample.runs.size(), 300U);
  EXPECT_EQ(sample.runs.count(7), 1U);
  EXPECT_EQ(failed_in(sample), 200U);
  EXPECT_LT(sample.runs.begin()->first, 20U);
  EXPECT_GT(sample.runs.rbegin()->first, 9900U);
  // Where few failed, all of these are there.
  EXPECT_EQ(failed_in(sample_of(candidate_of(10'000, 1000), 300)), 10U);
}

}  // namespace
}  // namespace tenon::sim
