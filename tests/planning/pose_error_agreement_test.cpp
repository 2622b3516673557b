// Planner and virtual arm mean the same by an environment that is off: where a tool stands to it,
// and where it stands to it after a move. Both against matrices written out here.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "planner/belief/belief.h"
#include "shared/base/random.h"
#include "shared/config/load.h"
#include "sim/cell/virtual_arm/start_joints.h"
#include "sim/cell/virtual_arm/virtual_cell.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "tests/support/planned.h"

namespace tenon::tests {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kPosition_m = 0.1e-3;
constexpr double kAngle_rad = 0.05 * kDegree;

/// Up to 30 mm and 10 degrees along and about every axis.
Vector6 random_error(Random& random) {
  Vector6 error;
  for (int axis = 0; axis < 6; ++axis) {
    error[axis] = (2.0 * random.uniform() - 1.0) * (axis < 3 ? 0.03 : 10.0 * kDegree / 1.7321);
  }
  return error;
}

/// A box high above a table that turns in every direction about a point beside it.
Task free_task() {
  Task task = box_task();
  task.coordinates = 0x3F;
  task.motion.carried_axes = false;
  task.error_about_m = {0.2, -0.3, 0.05};
  task.starts.resize(1);
  task.starts.front().pose.position_m = {-0.3, -0.2, 0.05};
  task.environment.resize(1);
  task.environment.front().size_m = {0.01, 0.01, 0.01};
  task.goal = task.starts.front().pose;
  return task;
}

/// The tool in the environment as it really stands, in homogeneous coordinates.
Eigen::Isometry3d by_matrices(const Task& task, const Pose& tool, const Vector6& error) {
  const Vector3 turn_rad = error.tail<3>();
  const Eigen::Translation3d about(task.error_about_m);
  const Eigen::Translation3d back(Vector3(-task.error_about_m));
  const Eigen::Isometry3d environment =
      Eigen::Translation3d(Vector3(error.head<3>())) * about *
      Eigen::Isometry3d(Eigen::AngleAxisd(turn_rad.norm(), turn_rad.normalized())) * back;
  return environment.inverse() * Eigen::Translation3d(tool.position_m) *
         Eigen::Isometry3d(tool.orientation);
}

void expect_there(const Pose& pose, const Eigen::Isometry3d& expected) {
  EXPECT_LT((pose.position_m - expected.translation()).norm(), kPosition_m);
  EXPECT_LT(pose.orientation.angularDistance(Eigen::Quaterniond(expected.rotation())), kAngle_rad);
}

TEST(PoseErrorAgreement, PlannerAndVirtualArmSeeTheToolAtOnePlace) {
  const Task task = free_task();
  const Start& start = task.starts.front();
  const Cell cell = shipped_cell("csp6");
  sim::VirtualCell::Options options;
  options.start = start.name;
  options.joints = sim::start_joints(cell, start.pose);
  Random random(17);
  for (int i = 0; i < 1000; ++i) {
    const Vector6 error = random_error(random);
    const Eigen::Isometry3d expected = by_matrices(task, start.pose, error);
    expect_there(planner::particle_off(-error, task, start, {}).tool(), expected);
    options.offset = error;
    expect_there(sim::VirtualCell(cell, task, options).truth().tool, expected);
  }
}

// A move is along the axes that the arm goes by, however the environment stands.
TEST(PoseErrorAgreement, AMoveTakesTheToolAlongTheArmsAxes) {
  const Task task = free_task();
  const Start& start = task.starts.front();
  sim::OdeRollout rollout(task);
  MoveParameters move;
  move.displacement << 0.05, -0.03, 0.02, 0.0, 0.0, 0.0;
  Random random(18);
  for (int i = 0; i < 50; ++i) {
    const Vector6 error = random_error(random);
    Particle particle = planner::particle_off(-error, task, start, {});
    const RolloutResult result = rollout.simulate(particle, move, 2000, nullptr);
    ASSERT_TRUE(result.valid) << result.failure;
    particle.pose = result.move.pose;
    expect_there(particle.tool(),
                 by_matrices(task, displaced(start.pose, move.displacement), error));
  }
}

}  // namespace
}  // namespace tenon::tests
