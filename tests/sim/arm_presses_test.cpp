// An arm of one axis that presses a part onto a plate: springs in series, whatever the plate is
// made of, and however thin it is.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "shared/base/random.h"
#include "shared/geometry/solid.h"
#include "sim/cell/virtual_arm/start_joints.h"
#include "tests/sim/arm_bench.h"
#include "tests/support/meshes.h"
#include "tests/support/planned.h"

namespace tenon::sim {
namespace {

constexpr double kContact_Npm = 3e4;  // parts and arm in series
constexpr double kPart_Npm = 1e6;     // of them what the parts have
constexpr double kServo_Npm = 1e6;
constexpr double kGap_m = 1e-3;  // at the start

Cell one_slider() {
  Cell cell = pendulum({0.1}, {1.0});
  cell.up_B = Vector3::UnitX();  // across the slider: nothing to carry
  Joint& joint = cell.robot.joints.front();
  joint.kind = Joint::Kind::kPrismatic;
  joint.axis = -Vector3::UnitZ();
  joint.lower = -1.0;
  joint.upper = 1.0;
  joint.stiffness = kServo_Npm;
  joint.effort_max = 1000.0;
  return cell;
}

Shape plate(Shape::Kind kind, double thickness_m) {
  Shape shape;
  shape.name = "plate";
  shape.kind = kind;
  shape.size_m = {0.04, 0.04, thickness_m};
  shape.pose.position_m.z() = -0.5 * thickness_m;
  if (kind == Shape::Kind::kSolid) {
    shape.solid = std::make_shared<const Solid>(tests::box_mesh(shape.size_m));
  }
  return shape;
}

/// A cube over a plate whose upper side is at z = 0.
Task cube_over(const Shape& plate) {
  Task task = empty_task();
  task.held.front().pose.position_m.z() = 0.01 + kGap_m;
  task.environment = {plate};
  return task;
}

struct Pressed {
  double joint_m = 0.0;
  double tool_m = 0.0;
  double force_N = 0.0;
  double least_N = 0.0;  ///< in the last tenth of a second
  double most_N = 0.0;   ///< likewise
  double overlap_m = 0.0;
};

/// Goes on so far after it has touched, and stays there.
Pressed pressed(const Shape& plate, double beyond_m) {
  constexpr double kSpeed_mps = 0.02;
  const Cell cell = one_slider();
  ArmBody::Parameters parameters = without_integral();
  parameters.contact_law.stiffness_Npm = kContact_Npm;
  ArmBody arm(cell, cube_over(plate), parameters);
  std::vector<ServoJoint::Demand> demands(1);
  ArmBench::enable(demands.front());
  demands.front().effort_max = cell.robot.joints.front().effort_max;
  const double z_m = arm.tool().position_m.z();
  const double to_m = kGap_m + beyond_m;
  Pressed seen;
  for (int i = 0; i < 1000; ++i) {
    ServoJoint::Demand& demand = demands.front();
    demand.velocity = demand.position + kSpeed_mps * kStep_s < to_m ? kSpeed_mps : 0.0;
    demand.position += demand.velocity * kStep_s;
    if (demand.velocity == 0.0) demand.position = to_m;
    arm.step(demands, kStep_s);
    seen.force_N = arm.wrench().z();
    if (i == 800) seen.least_N = seen.most_N = seen.force_N;
    seen.least_N = std::min(seen.least_N, seen.force_N);
    if (i >= 800) seen.most_N = std::max(seen.most_N, seen.force_N);
  }
  EXPECT_EQ(arm.solver_messages(), 0U);
  seen.joint_m = arm.joint(0).position;
  seen.tool_m = z_m - arm.tool().position_m.z();
  seen.overlap_m = arm.overlap_m();
  return seen;
}

void expect_springs_in_series(const Pressed& seen, double beyond_m) {
  const double force_N = beyond_m / (1.0 / kContact_Npm + 1.0 / kServo_Npm);
  EXPECT_NEAR(seen.force_N, force_N, 0.02);
  EXPECT_NEAR(seen.most_N - seen.least_N, 0.0, 0.01);
  EXPECT_NEAR(seen.overlap_m, force_N / kPart_Npm, 1e-6);
  EXPECT_NEAR(seen.tool_m, kGap_m + force_N / kPart_Npm, 1e-6);
  EXPECT_NEAR(seen.joint_m, kGap_m + force_N / kContact_Npm, 1e-6);
}

TEST(ArmPresses, OnABox) {
  for (const double beyond_m : {1e-4, 5e-4}) {
    expect_springs_in_series(pressed(plate(Shape::Kind::kBox, 0.01), beyond_m), beyond_m);
  }
}

TEST(ArmPresses, OnAMeshThatIsThinnerThanTheWay) {
  for (const double beyond_m : {1e-4, 5e-4}) {
    expect_springs_in_series(pressed(plate(Shape::Kind::kSolid, 4e-4), beyond_m), beyond_m);
  }
}

// Eight rows of friction on a part that is next to massless: the solver must tell them apart.
TEST(ArmPresses, AndSlidesInACornerOfTheTableWithASolverThatNeverGivesUp) {
  constexpr double kPerSegment_s = 0.1;
  constexpr double kSpeed_mps = 0.05;
  const Cell& cell = tests::gantry_cell();
  Pose corner = tests::box_start("1").pose;
  corner.position_m.head<2>() = Eigen::Vector2d(-0.449, -0.349);  // 1 mm off both walls
  ArmBody::Parameters parameters;
  parameters.start = start_joints(cell, corner);
  parameters.X_BE = cell.X_BT;
  parameters.contact_law.stiffness_Npm = cell.contact_stiffness_Npm;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    ArmBody arm(cell, tests::box_task(), parameters);
    std::vector<ServoJoint::Demand> demands(3);
    for (std::size_t i = 0; i < 3; ++i) {
      ArmBench::enable(demands[i]);
      demands[i].position = parameters.start[i];
      demands[i].effort_max = cell.robot.joints[i].effort_max;
    }
    double touched_N = 0.0;
    for (int segment = 0; segment < 40; ++segment) {
      const double to_m[] = {random.uniform(-1.5e-3, 3e-3), random.uniform(-1.5e-3, 3e-3)};
      for (double left_s = kPerSegment_s; left_s > 0.0; left_s -= kStep_s) {
        for (std::size_t i = 0; i < 2; ++i) {
          const double way_m = parameters.start[i] + to_m[i] - demands[i].position;
          const double step_m = std::clamp(way_m, -kSpeed_mps * kStep_s, kSpeed_mps * kStep_s);
          demands[i].velocity = step_m / kStep_s;
          demands[i].position += step_m;
        }
        arm.step(demands, kStep_s);
        touched_N = std::max(touched_N, arm.contact_force_N());
      }
    }
    EXPECT_GT(touched_N, 5.0) << seed;
    EXPECT_EQ(arm.solver_messages(), 0U) << seed;
  }
}

}  // namespace
}  // namespace tenon::sim
