// What it takes to find that a path does not hold.

#include "planner/judge/path_judge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "tests/planner/room_plan.h"

namespace tenon::planner {
namespace {

/// The room, in which nothing works from some places.
class HoledRollout final : public Rollout {
 public:
  explicit HoledRollout(std::vector<Vector3> holes_m)
      : holes_m_(std::move(holes_m)), walls_(room()) {}

  [[nodiscard]] RolloutResult simulate(const Particle& particle, const MoveParameters& move,
                                       std::int64_t step_us,
                                       std::vector<TraceSample>* trace) override {
    const bool in_hole = std::any_of(holes_m_.begin(), holes_m_.end(), [&](const Vector3& hole_m) {
      return (particle.pose.position_m - hole_m).norm() < 1e-9;
    });
    if (!in_hole) return walls_.simulate(particle, move, step_us, trace);
    RolloutResult result;
    result.failure = "it fell into the hole";
    return result;
  }
  [[nodiscard]] bool in_collision(const Pose& tool) override { return walls_.in_collision(tool); }
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override {
    return std::make_unique<HoledRollout>(holes_m_);
  }

 private:
  std::vector<Vector3> holes_m_;
  WallRollout walls_;
};

/// The room's task with its plan's path.
class PathJudgeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const PlanReport report = planned(task);
    ASSERT_TRUE(report.plan);
    plan = *report.plan;
    for (const Step& step : plan.steps) path.push_back(step.displacement);
  }

  [[nodiscard]] PathJudge judge_in(RolloutPool& pool) const {
    return {task, start, {}, pool, stopped_clock};
  }

  const Task task = room_task();
  const Start& start = task.starts.front();
  WallRollout walls{room()};
  Plan plan;
  std::vector<Vector6> path;
};

TEST_F(PathJudgeTest, WhoIsAskedToStopDecidesNothingAndCanBeAskedAgain) {
  RolloutPool pool(walls, 1);
  PathJudge judge = judge_in(pool);
  int until = 3;
  judge.stop_when([&until] { return until-- == 0; });
  EXPECT_TRUE(std::holds_alternative<Undecided>(judge.judge(path)));
  EXPECT_TRUE(std::holds_alternative<JudgedPlan>(judge.judge(path)));
}

// In the last corner, where certification has no particle: both errors are off.
TEST_F(PathJudgeTest, AStartThatAPathHasMissedIsRunFirstThroughItsVariants) {
  const std::vector<JudgedStart> corners = corner_starts(plan, task, start, walls);

  RolloutPool pool(HoledRollout({corners.back().particle.pose.position_m}), 1);
  PathJudge judge = judge_in(pool);
  const Judgement judgement = judge.judge(path);
  ASSERT_TRUE(std::holds_alternative<Refutation>(judgement));
  const Refutation& refutation = std::get<Refutation>(judgement);
  EXPECT_NE(refutation.why.find("missed the goal"), std::string::npos) << refutation.why;
  // After the look at some of them one plan has run all the corners, others that one alone.
  const std::vector<JudgedStart> looked = screening_starts(plan, task, start, walls);
  const std::uint64_t moves = judge.effort().corners.moves;
  EXPECT_GT(moves, (looked.size() + corners.size() / 2) * path.size());
  EXPECT_LE(moves, (looked.size() + corners.size()) * path.size());
  EXPECT_EQ(judge.effort().validation.moves, 0U);
}

// What the first look shows to miss is not certified before it is refuted.
TEST_F(PathJudgeTest, AStartThatTheFirstLookMissesFromRefutesAlone) {
  const std::vector<JudgedStart> looked = screening_starts(plan, task, start, walls);
  RolloutPool pool(HoledRollout({looked[4].particle.pose.position_m}), 1);
  PathJudge judge = judge_in(pool);
  const Judgement judgement = judge.judge(path);
  ASSERT_TRUE(std::holds_alternative<Refutation>(judgement));
  EXPECT_EQ(std::get<Refutation>(judgement).chain.start.pose.position_m,
            looked[4].particle.pose.position_m);
  EXPECT_EQ(judge.effort().moves(), judge.effort().corners.moves);
}

// Whoever makes the way anew needs them all, and soon.
TEST_F(PathJudgeTest, EveryCornerThatMissesIsToldBeforeAnythingElseIsAsked) {
  const std::vector<JudgedStart> looked = screening_starts(plan, task, start, walls);
  const std::vector<Vector3> holes_m = {looked[4].particle.pose.position_m,
                                        looked.back().particle.pose.position_m};

  RolloutPool pool(HoledRollout(holes_m), 1);
  PathJudge judge = judge_in(pool);
  const Judgement judgement = judge.judge(path, PathJudge::Asker::kGuide);
  ASSERT_TRUE(std::holds_alternative<Refutation>(judgement));
  std::vector<Vector3> told_m;
  for (const Particle& other : std::get<Refutation>(judgement).others) {
    told_m.push_back(other.pose.position_m);
  }
  EXPECT_EQ(told_m, holes_m);
  EXPECT_LE(judge.effort().corners.moves, looked.size() * path.size());
  EXPECT_EQ(judge.effort().moves(), judge.effort().corners.moves);
}

TEST_F(PathJudgeTest, ARefutationTellsWhetherItsStartWouldHaveMissedWithoutItsTilt) {
  Task tilting = task;
  tilting.tilt_rad = 2e-4;
  const auto by_calibration = [&](const Rollout& rollout, double held_rad) {
    RolloutPool pool(rollout, 1);
    PathJudge judge(tilting, start, {}, pool, stopped_clock);
    judge.hold({held_rad, 0.0});
    const Judgement judgement = judge.judge(path);
    const auto* refutation = std::get_if<Refutation>(&judgement);
    return refutation == nullptr ? std::nullopt : std::optional(refutation->by_calibration);
  };
  WallRollout::World narrow = room();
  narrow.narrow_beyond_tilt_rad = 1e-4;
  EXPECT_EQ(by_calibration(WallRollout(narrow), 2e-4), true);
  EXPECT_EQ(by_calibration(WallRollout(narrow), 0.99e-4), std::nullopt) << "it holds";

  const std::vector<JudgedStart> corners = corner_starts(plan, tilting, start, walls);
  ASSERT_GT(tilt_of(corners.back().particle, tilting, start).norm_rad(), 0.0);
  EXPECT_EQ(by_calibration(HoledRollout({corners.back().particle.pose.position_m}), 2e-4), false);
}

TEST_F(PathJudgeTest, WhatHoldsAtItsSpeedsIsCertifiedForThoseAlone) {
  RolloutPool pool(WallRollout(room()), 1);
  for (const auto asker : {PathJudge::Asker::kSearch, PathJudge::Asker::kGuide}) {
    PathJudge judge = judge_in(pool);
    const Judgement judgement = judge.judge(path, asker);
    ASSERT_TRUE(std::holds_alternative<JudgedPlan>(judgement));
    const auto& judged = std::get<JudgedPlan>(judgement);
    EXPECT_EQ(judged.estimate.at_goal(), kDrawsMin);
    std::uint64_t moves = 0;
    for (const VariantRun& run : judged.certification.runs) {
      for (const Chain& chain : run.chains) moves += chain.steps.size();
    }
    // Here the tool has to be slow earlier than the corners show: certified for both speeds.
    EXPECT_EQ(judge.effort().certification.moves, 2 * moves);
  }
}

}  // namespace
}  // namespace tenon::planner
