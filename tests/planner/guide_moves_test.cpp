// The moves that guides suggest, how certain a goal must be by default, and what a task without
// primitives plans with.

#include "planner/search/guide_moves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

#include "planner/goal_certainty.h"
#include "shared/task/own_moves.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

BeliefSummary belief_at(double x_m, double y_m, double spread_m) {
  BeliefSummary belief;
  belief.mean.position_m = {x_m, y_m, 0.0};
  belief.spread.head<2>().setConstant(spread_m);
  belief.uncertainty_m2 = spread_m * spread_m;
  return belief;
}

Guide guide_by_a_wall(const Task& task) {
  ContactAttractor wall;
  wall.axis = 0;
  wall.sign = -1;
  wall.mean.position_m = {-0.5, 0.1, 0.0};
  wall.via = Pose{{-0.3, 0.1, 0.0}, Eigen::Quaterniond::Identity()};
  return {{wall}, {task.goal}, 1.0};
}

std::set<std::pair<double, double>> ways(const std::vector<Primitive>& moves) {
  std::set<std::pair<double, double>> all;
  for (const Primitive& move : moves) {
    all.emplace(std::round(1e4 * move.displacement.x()), std::round(1e4 * move.displacement.y()));
  }
  return all;
}

TEST(GuideMoves, LeadToWhereAPushBeginsAndPushPastTheFarthestParticle) {
  const Task task = own_room_task();
  const BeliefSummary belief = belief_at(0.0, -0.1, 0.05);
  const auto moves = guide_moves(task, belief, {guide_by_a_wall(task)});
  // Along x to the push's beginning; along y, which is also all of the way but the push's axis; and
  // from here 0.5 m to the wall, 0.05 m for who is last, and a step.
  const double push_m = 0.5 + 0.05 + task.step_m;
  EXPECT_EQ(ways(moves), (std::set<std::pair<double, double>>{
                             {-3000, 0}, {0, 2000}, {-std::round(1e4 * push_m), 0}}));
  std::set<int> labels;
  for (const Primitive& move : moves) labels.insert(move.label);
  EXPECT_EQ(labels.size(), moves.size());
  EXPECT_EQ(*labels.begin(), kGuideLabel);
}

TEST(GuideMoves, LeadToTheGoalAxisByAxisOnceTheContactsAreBehind) {
  const Task task = own_room_task();
  const auto moves = guide_moves(task, belief_at(-0.49, 0.1, 0.0), {guide_by_a_wall(task)});
  EXPECT_EQ(ways(moves), (std::set<std::pair<double, double>>{{6600, 0}, {0, 200}, {6600, 200}}));
}

TEST(GuideMoves, AreLeftOutWhereTheyWouldRunOutOfTime) {
  Task task = own_room_task();
  task.motion.timeout_us = 6'000'000;  // at 0.05 m/s a push of 0.65 m takes 13 s
  const auto moves = guide_moves(task, belief_at(0.0, -0.1, 0.05), {guide_by_a_wall(task)});
  EXPECT_EQ(ways(moves), (std::set<std::pair<double, double>>{{0, 2000}}));
}

TEST(OwnMoves, FollowFromTheSizesOfTheTask) {
  Task task = own_room_task();
  EXPECT_TRUE(task.guide_moves);
  EXPECT_DOUBLE_EQ(task.step_m, 1.2 * task.particle_sigmas * 0.03);
  EXPECT_GE(task.long_step_m, 1.0 + 2.0 * task.particle_sigmas * 0.03);
  EXPECT_DOUBLE_EQ(task.move_weight, task.distance_weight_per_m * task.goal_tolerance_m);
  const double long_before_m = task.long_step_m;
  task.environment.front().size_m.x() = 3.0;
  derive_moves(task);
  EXPECT_GT(task.long_step_m, long_before_m + 1.7);
}

TEST(GoalCertainty, IsAQuarterOfTheRoomThatTheGoalLeaves) {
  Task task = room_task();
  WallRollout::World narrow = room();
  narrow.low_m.x() = task.goal.position_m.x() - 0.7e-3;
  narrow.high_m.x() = task.goal.position_m.x() + 0.5e-3;
  WallRollout rollout(narrow);
  EXPECT_EQ(with_goal_certainty(task, rollout).goal_uncertainty_m2, task.goal_uncertainty_m2);
  task.goal_uncertainty_m2 = 0.0;
  // The narrowest mean of both ways is 0.6 mm: a standard deviation of 0.3 mm for each of x and y.
  EXPECT_NEAR(with_goal_certainty(task, rollout).goal_uncertainty_m2, 2.0 * 0.09e-6, 0.01e-6);
  WallRollout open(room());
  EXPECT_NEAR(with_goal_certainty(task, open).goal_uncertainty_m2, 2e-6, 1e-9);
}

/// Room for a turn about z by 0.01 rad either way, and for any way.
class NarrowTurn final : public Rollout {
 public:
  [[nodiscard]] RolloutResult simulate(const Particle& /*particle*/, const MoveParameters& /*move*/,
                                       std::int64_t /*step_us*/,
                                       std::vector<TraceSample>* /*trace*/) override {
    return {};
  }
  [[nodiscard]] bool in_collision(const Pose& tool) override {
    return std::abs(rotation_vector(tool.orientation).z()) > 0.01;
  }
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override {
    return std::make_unique<NarrowTurn>();
  }
};

TEST(GoalCertainty, CountsTheRoomOfAnAngleThatHasAToleranceOfItsOwn) {
  Task task = room_task();
  task.coordinates = 0b100011;
  task.goal_uncertainty_m2 = 0.0;
  NarrowTurn rollout;
  const double any_m2 = with_goal_certainty(task, rollout).goal_uncertainty_m2;
  // An eighth of what the axis may be off by: so much of the goal's tolerance, halved.
  task.goal_axes.tolerance[5] = 0.08;
  const double deviation_m = 0.5 * task.goal_tolerance_m / 8.0;
  EXPECT_NEAR(with_goal_certainty(task, rollout).goal_uncertainty_m2,
              3.0 * deviation_m * deviation_m, 0.03 * deviation_m * deviation_m);
  // There is enough.
  task.goal_axes.tolerance[5] = 0.005;
  EXPECT_NEAR(with_goal_certainty(task, rollout).goal_uncertainty_m2, any_m2, 1e-12);
}

}  // namespace
}  // namespace tenon::planner
