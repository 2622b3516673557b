#include "planner/belief/belief.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "planner/belief/belief_summary.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

Particle at(double x, double y, const Vector3& turn_rad = Vector3::Zero()) {
  Particle particle;
  particle.pose.position_m = {x, y, 0.0};
  particle.pose.orientation = rotation_of(turn_rad);
  return particle;
}

TEST(Belief, InACellEveryPairingOfFrictionAndLatencyStandsAmongTheParticles) {
  const Task task = room_task();
  const Belief belief = in_cell(cross_polytope(task, task.starts.front()), 3e4, 0.008);
  std::set<std::pair<double, double>> pairings;
  for (const Particle& particle : belief.particles) {
    EXPECT_EQ(particle.physics.contact_stiffness_Npm, 3e4);
    pairings.emplace(particle.physics.friction, particle.physics.latency_s);
  }
  const std::set<std::pair<double, double>> expected = {{task.friction.low, 0.0},
                                                        {task.friction.low, 0.008},
                                                        {task.friction.high, 0.0},
                                                        {task.friction.high, 0.008}};
  EXPECT_EQ(pairings, expected);
}

TEST(Belief, ParticlesSitOnTheTipsOfTheCrossPolytopeAndNotInItsCentre) {
  const Task task = room_task();
  const Belief belief = cross_polytope(task, task.starts.front());
  ASSERT_EQ(belief.particles.size(), 4U);
  EXPECT_DOUBLE_EQ(belief.particles[0].pose.position_m.x(), -0.23 + 0.06);
  EXPECT_DOUBLE_EQ(belief.particles[1].pose.position_m.x(), -0.23 - 0.06);
  EXPECT_DOUBLE_EQ(belief.particles[2].pose.position_m.y(), -0.11 + 0.06);
  EXPECT_DOUBLE_EQ(belief.particles[3].pose.position_m.y(), -0.11 - 0.06);
  EXPECT_DOUBLE_EQ(belief.particles[2].pose.position_m.x(), -0.23);
}

TEST(Belief, BothExtremesOfFrictionStandOnEveryAxis) {
  const Task task = room_task();
  const auto p = cross_polytope(task, task.starts.front()).particles;
  EXPECT_EQ(p[0].physics.friction, task.friction.low);
  EXPECT_EQ(p[1].physics.friction, task.friction.high);
  EXPECT_EQ(p[2].physics.friction, task.friction.high);
  EXPECT_EQ(p[3].physics.friction, task.friction.low);
}

TEST(Belief, UncertaintyIsTheTraceOfTheCovariance) {
  const Metric metric{3.0};
  // Var x = (2 * 0.06^2) / 4 = 0.0018, the same for y.
  const Belief cross{{at(0.06, 0), at(-0.06, 0), at(0, 0.06), at(0, -0.06)}};
  EXPECT_NEAR(uncertainty(cross, metric), 0.0036, 1e-15);
  // Two turned by +-0.1 rad about z: variance 0.01.
  const Belief turned{{at(0, 0, {0, 0, 0.1}), at(0, 0, {0, 0, -0.1})}};
  EXPECT_NEAR(uncertainty(turned, metric), 3.0 * 0.01, 1e-12);
}

TEST(Belief, GeodesicMeanIgnoresTheWrapAtHalfATurn) {
  // 170 and 190 degrees about z: a plain mean of rotation vectors would say 0.
  const Belief belief{
      {at(0, 0, {0, 0, 170.0 * M_PI / 180.0}), at(0, 0, {0, 0, -170.0 * M_PI / 180.0})}};
  const Pose mean = mean_pose(belief);
  EXPECT_NEAR(mean.orientation.angularDistance(rotation_of({0, 0, M_PI})), 0.0, 1e-12);
  const double ten_rad = 10.0 * M_PI / 180.0;
  EXPECT_NEAR(uncertainty(belief, {1.0}), ten_rad * ten_rad, 1e-12);
}

TEST(Belief, GeodesicMeanDoesNotDependOnTheFrame) {
  const Belief belief{
      {at(0, 0, {0.4, 0.1, 0}), at(0, 0, {-0.2, 0.5, 0.3}), at(0, 0, {0, -0.3, 0.9})}};
  const Eigen::Quaterniond turn = rotation_of({1.0, -2.0, 0.5});
  Belief seen = belief;
  for (Particle& p : seen.particles) p.pose.orientation = turn * p.pose.orientation;
  EXPECT_NEAR(mean_pose(seen).orientation.angularDistance(turn * mean_pose(belief).orientation),
              0.0, 1e-12);
}

TEST(Belief, GeodesicMeanOfTwoIsHalfTheTurnBetweenThem) {
  const Eigen::Quaterniond base = rotation_of({0.7, -0.4, 0.2});
  const Vector3 turn_rad(0.3, 0.5, -0.8);
  Belief belief{{at(0, 0), at(0, 0)}};
  belief.particles[0].pose.orientation = base;
  belief.particles[1].pose.orientation = rotation_of(turn_rad) * base;
  const Eigen::Quaterniond half = rotation_of(0.5 * turn_rad) * base;
  EXPECT_NEAR(mean_pose(belief).orientation.angularDistance(half), 0.0, 1e-9);
  // Each stands half the turn off: the trace of their covariance is its square.
  EXPECT_NEAR(uncertainty(belief, {1.0}), 0.25 * turn_rad.squaredNorm(), 1e-9);
}

TEST(Belief, TurnsAboutOneAxisHaveTheMeanAndVarianceOfTheirAngles) {
  const Vector3 axis = Vector3(1.0, 2.0, -2.0) / 3.0;
  const Belief belief{{at(0, 0, 0.1 * axis), at(0, 0, 0.3 * axis), at(0, 0, 0.8 * axis)}};
  EXPECT_NEAR(mean_pose(belief).orientation.angularDistance(rotation_of(0.4 * axis)), 0.0, 1e-9);
  EXPECT_NEAR(uncertainty(belief, {1.0}), (0.09 + 0.01 + 0.16) / 3.0, 1e-9);
}

TEST(Belief, DistanceIsAMetric) {
  const Metric metric{0.5};
  const std::array poses = {at(0, 0).pose, at(0.3, -0.1, {0.4, 0.1, 0}).pose,
                            at(-0.2, 0.5, {-1.2, 0.5, 2.3}).pose, at(0, 0.1, {0, 0, 3.1}).pose};
  for (const Pose& a : poses) {
    EXPECT_NEAR(distance(a, a, metric), 0.0, 1e-7);
    for (const Pose& b : poses) {
      EXPECT_NEAR(distance(a, b, metric), distance(b, a, metric), 1e-12);
      for (const Pose& c : poses) {
        EXPECT_LE(distance(a, c, metric), distance(a, b, metric) + distance(b, c, metric) + 1e-12);
      }
    }
  }
}

TEST(Belief, DistanceAddsTranslationAndAngle) {
  const Metric metric{0.5};
  EXPECT_NEAR(distance(at(0, 0).pose, at(0.3, 0.4, {0, 0, 0.2}).pose, metric), 0.5 + 0.5 * 0.2,
              1e-12);
}

TEST(Belief, IdentityTellsContactsApartAndForgivesMicrometres) {
  const Grid grid;
  const Belief one{{at(0.1, 0.2)}};
  Belief other = one;
  other.particles[0].pose.position_m.x() += 1e-5;
  EXPECT_EQ(identity(one, grid), identity(other, grid));
  other.particles[0].signature.bits = ContactSignature::bit(0, -1);
  EXPECT_NE(identity(one, grid), identity(other, grid));
  other = one;
  other.particles[0].pose.position_m.x() += 2e-3;
  EXPECT_NE(identity(one, grid), identity(other, grid));
}

// What is free at the goal need not become certain; what has a tolerance of its own weighs as that.
TEST(Belief, AxesOfTheirOwnWeighAsTheirTolerancesDo) {
  Task task = room_task();
  const Belief belief{{at(0.1, 0.0), at(-0.1, 0.0), at(0.0, 0.3), at(0.0, -0.3)}};
  const double x_m2 = 0.01 / 2.0;
  const double y_m2 = 0.09 / 2.0;
  EXPECT_NEAR(uncertainty(belief, metric_of(task)), x_m2 + y_m2, 1e-12);
  task.goal_axes.free = 0b10;
  EXPECT_NEAR(uncertainty(belief, metric_of(task)), x_m2, 1e-12);
  task.goal_axes.free = 0;
  task.goal_axes.tolerance[1] = 3.0 * task.goal_tolerance_m;
  EXPECT_NEAR(uncertainty(belief, metric_of(task)), x_m2 + y_m2 / 9.0, 1e-12);
  task.goal_axes.tolerance[1] = 1e-5;
  EXPECT_NEAR(grid_of(task).cell_m, 1e-6, 1e-12);
}

TEST(Belief, IsAtTheGoalWhereEveryAxisIsWithinItsOwn) {
  Task task = room_task();
  const auto arrived = [&](double off_x_m, double off_y_m) {
    const Pose& goal = task.goal;
    const Belief belief{{at(goal.position_m.x() + off_x_m, goal.position_m.y() + off_y_m)}};
    return at_goal(summarise(belief, task), task);
  };
  const double half_m = 0.5 * task.goal_tolerance_m;
  EXPECT_TRUE(arrived(0.9 * half_m, 0.0));
  EXPECT_FALSE(arrived(0.9 * half_m, 0.9 * half_m));
  task.goal_axes.tolerance[1] = task.goal_tolerance_m;
  EXPECT_TRUE(arrived(0.9 * half_m, 0.9 * half_m));
  EXPECT_FALSE(arrived(0.0, 1.1 * half_m));
  task.goal_axes.tolerance[1] = 0.0;
  task.goal_axes.free = 0b10;
  EXPECT_TRUE(arrived(0.9 * half_m, 0.2));
  EXPECT_FALSE(arrived(1.1 * half_m, 0.0));
}

TEST(Belief, StatesAreToldApartFinerThanTheGoalsTolerance) {
  // Ten micrometres, less than a cell where the goal asks for nothing finer.
  Task task = room_task();
  EXPECT_EQ(grid_of(task).cell_m, Grid{}.cell_m);
  task.goal_tolerance_m = 1e-5;
  for (const double off_m : {0.3e-5, 0.6e-5, 0.9e-5}) {
    const Belief inside{{at(0.1 + off_m, 0.2)}};
    const Belief outside{{at(0.1 + off_m + task.goal_tolerance_m, 0.2)}};
    EXPECT_NE(identity(inside, grid_of(task)), identity(outside, grid_of(task)));
  }
  const Belief straight{{at(0.1, 0.2)}};
  const Belief turned{{at(0.1, 0.2, {0.0, 0.0, task.goal_tolerance_m / task.orientation_weight})}};
  EXPECT_NE(identity(straight, grid_of(task)), identity(turned, grid_of(task)));
}

}  // namespace
}  // namespace tenon::planner
