// Starts in which several errors are at their largest at once.

#include "planner/belief/corners.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

Task turned_task(CoordinateMask coordinates) {
  Task task = room_task();
  task.coordinates = coordinates;
  task.errors = Distribution::kUniform;
  task.particle_sigmas = std::sqrt(3.0);
  Vector6& sigma = task.starts.front().sigma;
  sigma.setZero();
  for (int axis = 0; axis < 6; ++axis) {
    if (has(coordinates, axis)) sigma[axis] = (axis < 3 ? 2e-3 : 0.05) / task.particle_sigmas;
  }
  return task;
}

/// The sides on which a particle's errors are; its turn is the environment's the other way.
Vector6 error_sides(const Particle& particle, const Task& task) {
  Vector6 off = Vector6::Zero();
  off.head<3>() = particle.pose.position_m - task.starts.front().pose.position_m;
  off.tail<3>() = -rotation_vector(particle.environment.orientation);
  return off.cwiseSign();
}

TEST(CornerBelief, HasEveryCornerOfThreeCoordinates) {
  const Task task = turned_task(0b000111);
  std::set<std::vector<double>> corners;
  for (const Particle& particle : corner_belief(task, task.starts.front()).particles) {
    const Vector3 off_m = particle.pose.position_m - task.starts.front().pose.position_m;
    EXPECT_LT((off_m.cwiseAbs() - Vector3::Constant(2e-3)).norm(), 1e-12);
    corners.insert({off_m.x(), off_m.y(), off_m.z()});
  }
  EXPECT_EQ(corners.size(), 8U);
}

TEST(CornerBelief, OfSixCoordinatesEveryTwoMeetInAllFourWays) {
  const Task task = turned_task(0b111111);
  const Belief belief = corner_belief(task, task.starts.front());
  EXPECT_EQ(belief.particles.size(), 16U);
  // Half of them turn about a slanted axis, so it is signs that are counted.
  for (int a = 0; a < 6; ++a) {
    for (int b = 0; b < a; ++b) {
      std::set<std::pair<double, double>> ways;
      for (const Particle& particle : belief.particles) {
        const Vector6 side = error_sides(particle, task);
        ways.insert({side[a], side[b]});
      }
      EXPECT_EQ(ways.size(), 4U) << a << " and " << b;
    }
  }
}

TEST(CornerBelief, OfNormalErrorsIsAsFarOutAsTheParticles) {
  Task task = turned_task(0b000011);
  task.errors = Distribution::kNormal;
  task.particle_sigmas = 2.0;
  const Start& start = task.starts.front();
  for (const Particle& particle : corner_belief(task, start).particles) {
    const Vector3 off_m = particle.pose.position_m - start.pose.position_m;
    EXPECT_NEAR(off_m.norm() / start.sigma[0], 2.0, 1e-9);
  }
}

TEST(CornerBelief, IsOneParticleWhereNothingIsUncertain) {
  Task task = turned_task(0b000011);
  task.starts.front().sigma.setZero();
  EXPECT_EQ(corner_belief(task, task.starts.front()).particles.size(), 1U);
}

}  // namespace
}  // namespace tenon::planner
