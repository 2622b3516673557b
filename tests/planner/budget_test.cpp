// What ends a search that finds nothing, and what is said meanwhile.

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "planner/calibration_effort.h"
#include "planner/search_moves.h"
#include "tests/planner/room_plan.h"

namespace tenon::planner {
namespace {

TEST(CalibrationEffort, AnotherPathIsLookedForAsLongAsTheFirstTookOrAHundredRunsOfItWould) {
  constexpr std::size_t kSteps = 20;
  for (const std::uint64_t first : {100U, 5000U}) {
    const std::uint64_t allowed = first == 100U ? 100 * kSteps : first;
    CalibrationEffort effort;
    effort.begin(0, {});
    effort.refute(false, kSteps, first);
    EXPECT_FALSE(effort.refuted()) << "not by a tilt";
    effort.refute(true, kSteps, first);
    EXPECT_TRUE(effort.refuted());
    EXPECT_FALSE(effort.spent(first + allowed - 1));
    EXPECT_TRUE(effort.spent(first + allowed));
    // From each that is found and refuted once more, up to eight of them.
    std::uint64_t moves = first;
    for (int path = 2; path <= 8; ++path) {
      EXPECT_FALSE(effort.spent(moves));
      effort.refute(true, 2 * kSteps, moves += allowed - 1);
    }
    EXPECT_TRUE(effort.spent(moves));

    // A smaller tilt is worth more.
    effort.begin(moves, {});
    EXPECT_FALSE(effort.spent(moves + 20 * allowed)) << "not refuted yet";
    effort.refute(true, kSteps, moves);
    EXPECT_FALSE(effort.spent(moves + 10 * allowed - 1));
    EXPECT_TRUE(effort.spent(moves + 10 * allowed));
  }
}

TEST(SearchMoves, WhatCannotTurnIsSearchedAtTwiceTheStep) {
  Task task = room_task();
  EXPECT_EQ(search_step_us(task), 2 * task.rollout_step_us);
  task.compliance.compliant_axes = 0b100011;
  EXPECT_EQ(search_step_us(task), task.rollout_step_us);
}

/// The room, in which every rollout takes its time by a clock that nothing else moves.
class SlowRollout final : public Rollout {
 public:
  SlowRollout(double each_s, std::shared_ptr<double> now_s)
      : each_s_(each_s), now_s_(std::move(now_s)) {}

  [[nodiscard]] RolloutResult simulate(const Particle& particle, const MoveParameters& move,
                                       std::int64_t step_us,
                                       std::vector<TraceSample>* trace) override {
    *now_s_ += each_s_;
    return room_.simulate(particle, move, step_us, trace);
  }
  [[nodiscard]] bool in_collision(const Pose& tool_pose) override {
    return room_.in_collision(tool_pose);
  }
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override {
    return std::make_unique<SlowRollout>(each_s_, now_s_);
  }

 private:
  double each_s_;
  std::shared_ptr<double> now_s_;  // one thread
  WallRollout room_{room()};
};

std::uint64_t moves_of(const PlanReport& report) {
  return report.search_moves.rollouts + report.attractor_moves.rollouts + report.judging.moves();
}

PlanReport within_moves(std::uint64_t moves, std::size_t threads) {
  PlannerOptions options;
  options.moves_max = moves;
  options.threads = threads;
  return planned(room_task(), room(), options);
}

TEST(Budget, TheMoveLimitIsAReasonOfItsOwn) {
  const PlanReport report = within_moves(100, 1);
  EXPECT_EQ(report.status, PlanStatus::kMoveLimit);
  EXPECT_NE(report.reason.find("100 simulated moves (raise --move-limit)"), std::string::npos)
      << report.reason;
  EXPECT_FALSE(report.plan.has_value());
  EXPECT_GE(moves_of(report), 100U);
  const PlanReport single = within_moves(1, 1);
  EXPECT_NE(single.reason.find("no path within 1 simulated move ("), std::string::npos)
      << single.reason;
}

TEST(Budget, TheMoveLimitStrikesInTheSamePlaceAtAnyNumberOfThreads) {
  for (const std::uint64_t moves : {1U, 60U, 150U}) {
    const PlanReport one = within_moves(moves, 1);
    const PlanReport five = within_moves(moves, 5);
    EXPECT_EQ(one.status, five.status);
    EXPECT_EQ(one.expansions, five.expansions);
    EXPECT_EQ(moves_of(one), moves_of(five));
    EXPECT_EQ(one.reason, five.reason);
  }
}

TEST(Budget, AMoveLimitThatSufficesLeavesThePlanAsItIs) {
  const PlanReport free = planned(room_task());
  ASSERT_EQ(free.status, PlanStatus::kPlanned);
  EXPECT_EQ(within_moves(moves_of(free), 1).bytes, free.bytes);
}

// Judging is most of the work: who had said how long to plan for had waited for all of it.
TEST(Budget, TheTimeLimitHoldsWhileAPathIsJudgedToo) {
  Task task = room_task();
  const auto now_s = std::make_shared<double>(0.0);
  const auto plan = [&] {
    *now_s = 0.0;
    return make_plan(task, task.starts.front(), SlowRollout(1.0, now_s), PlannerOptions{},
                     [&] { return *now_s; });
  };
  task.time_limit_s = 1e6;
  const PlanReport free = plan();
  ASSERT_EQ(free.status, PlanStatus::kPlanned) << free.reason;
  ASSERT_GT(free.judging.moves(), 1000U);

  task.time_limit_s = *now_s - 0.5 * static_cast<double>(free.judging.moves());
  const PlanReport limited = plan();
  EXPECT_EQ(limited.status, PlanStatus::kTimeLimit);
  EXPECT_NE(limited.reason.find("raise --time-limit"), std::string::npos) << limited.reason;
  EXPECT_FALSE(limited.plan.has_value());
  EXPECT_GE(*now_s, task.time_limit_s);
  // What is begun at once: some dozens of starts.
  EXPECT_LE(*now_s, task.time_limit_s + 64.0 * static_cast<double>(free.plan->steps.size()));
}

// clock    0 ....... 0.35 ....... 0.7 ....... 1.05 s   each rollout takes 0.35 s
// told                                         ^ silent for a second
TEST(Budget, ProgressIsNeverSilentForTwoSeconds) {
  Task task = room_task();
  task.time_limit_s = 1e6;
  const auto now_s = std::make_shared<double>(0.0);
  std::vector<double> told_s = {0.0};
  std::string said;
  PlannerOptions options;
  options.progress = [&](const std::string& line) {
    told_s.push_back(*now_s);
    said += line + "\n";
  };
  const PlanReport report = make_plan(task, task.starts.front(), SlowRollout(0.35, now_s), options,
                                      [&] { return *now_s; });
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  told_s.push_back(*now_s);
  ASSERT_GT(*now_s, 100.0);
  for (std::size_t i = 1; i < told_s.size(); ++i) {
    EXPECT_LT(told_s[i] - told_s[i - 1], 2.0) << i;
  }
  for (const char* doing : {"looking for guides, ", "searching, ", "judging a path, "}) {
    EXPECT_NE(said.find(doing), std::string::npos) << doing;
  }
}

}  // namespace
}  // namespace tenon::planner
