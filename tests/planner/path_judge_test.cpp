// What it takes to find that a path does not hold.

#include "planner/judge/path_judge.h"

#include <gtest/gtest.h>

#include <memory>
#include <variant>
#include <vector>

#include "tests/planner/room_plan.h"

namespace tenon::planner {
namespace {

/// The room, in which nothing works from one place.
class HoledRollout final : public Rollout {
 public:
  explicit HoledRollout(const Vector3& hole_m) : hole_m_(hole_m), walls_(room()) {}

  [[nodiscard]] RolloutResult simulate(const Particle& particle, const MoveParameters& move,
                                       std::int64_t step_us,
                                       std::vector<TraceSample>* trace) override {
    const bool in_hole = (particle.pose.position_m - hole_m_).norm() < 1e-9;
    if (!in_hole) return walls_.simulate(particle, move, step_us, trace);
    RolloutResult result;
    result.failure = "it fell into the hole";
    return result;
  }
  [[nodiscard]] bool in_collision(const Pose& tool) override { return walls_.in_collision(tool); }
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override {
    return std::make_unique<HoledRollout>(hole_m_);
  }

 private:
  Vector3 hole_m_;
  WallRollout walls_;
};

// In the last corner, where certification has no particle: both errors are off.
TEST(PathJudge, AStartThatAPathHasMissedIsRunFirstThroughItsVariants) {
  const Task task = room_task();
  const Start& start = task.starts.front();
  const PlanReport report = planned(task);
  ASSERT_TRUE(report.plan);
  std::vector<Vector6> displacements;
  for (const Step& step : report.plan->steps) displacements.push_back(step.displacement);
  WallRollout walls(room());
  const std::vector<JudgedStart> corners = corner_starts(*report.plan, task, start, walls);

  RolloutPool pool(HoledRollout(corners.back().particle.pose.position_m), 1);
  PathJudge judge(task, start, {}, pool, stopped_clock);
  const Judgement judgement = judge.judge(displacements);
  ASSERT_TRUE(std::holds_alternative<Refutation>(judgement));
  const Refutation& refutation = std::get<Refutation>(judgement);
  EXPECT_NE(refutation.why.find("missed the goal"), std::string::npos) << refutation.why;
  // The fast plan has run all the corners, the slow one that one alone.
  const std::uint64_t moves = judge.effort().validation_moves;
  EXPECT_GT(moves, (corners.size() / 2) * displacements.size());
  EXPECT_LE(moves, corners.size() * displacements.size());
}

}  // namespace
}  // namespace tenon::planner
