// Force from the joints' efforts: friction identified over CAN on a virtual arm whose friction was
// drawn, and the error of the estimated wrench against a model of its own.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "executor/identification/identify_friction.h"
#include "executor/sensing/joint_torque_wrench.h"
#include "shared/kinematics/inverse_dynamics.h"
#include "sim/cell/virtual_arm/drive_friction.h"
#include "tests/support/rough_arm.h"

namespace tenon::tests {
namespace {

using executor::JointTorqueWrench;

class FrictionOf : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, FrictionOf, ::testing::Values("gantry3", "csp6_peg"),
                         [](const auto& cell) { return std::string(cell.param); });

/// What each joint moves, stretched out: kg or kg m^2.
JointVector inertia_of_joints(const Cell& cell) {
  JointVector inertia{};
  for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
    JointVector unit{};
    unit[i] = 1.0;
    const InverseDynamics dynamics(cell);
    inertia[i] = dynamics.effort({}, {}, unit)[i] - dynamics.effort({}, {}, {})[i];
  }
  return inertia;
}

// What is hysteresis follows the motion as well, and partly passes for Coulomb's. Viscous friction
// of ways as slow as these is next to nothing: the drives' noise moves it by a count per m/s or
// rad/s, of some three by which hysteresis does.
TEST_P(FrictionOf, IsFoundOverCanAsItWasDrawn) {
  const Cell cell = torque_cell(GetParam());
  const sim::WorldDraw world = rough_world(0.02, 0.10, 7);
  const auto found = identified(cell, world);
  ASSERT_EQ(found.status, executor::FrictionIdentification::Status::kIdentified)
      << describe(cell.robot, found);
  const JointVector inertia = inertia_of_joints(cell);
  for (std::size_t i = 0; i < found.joints.size(); ++i) {
    const Joint& joint = cell.robot.joints[i];
    const sim::DriveFriction& drawn = world.drive_friction[i];
    const double coulomb = drawn.coulomb_share * joint.rated_effort;
    const double hysteresis = drawn.hysteresis_share * joint.rated_effort;
    const double viscous = drawn.viscous_share * joint.rated_effort / joint.speed_max;
    const double count = 1e-3 * joint.rated_effort;
    std::printf(
        "%s: Coulomb %.3f of %.3f, hysteresis %.3f of %.3f, viscous %.3f of %.3f, offset %.3f, "
        "residual %.3f\n",
        joint.name.c_str(), found.joints[i].coulomb, coulomb, found.joints[i].hysteresis,
        hysteresis, found.joints[i].viscous, viscous, found.joints[i].offset,
        found.joints[i].residual);
    EXPECT_GT(found.joints[i].coulomb, coulomb - count) << joint.name;
    EXPECT_LT(found.joints[i].coulomb, coulomb + hysteresis + count) << joint.name;
    EXPECT_NEAR(found.joints[i].viscous, viscous, 0.1 * viscous + 4.5 * count) << joint.name;
    EXPECT_LT(std::abs(found.joints[i].offset), 0.5 * hysteresis + count) << joint.name;
    const double cycle_s = 1e-6 * cell.robot.cycle_us;
    const double encoder = inertia[i] / joint.counts_per_unit / (cycle_s * cycle_s);
    EXPECT_LT(found.joints[i].residual, 2.5 * hysteresis + 4.0 * count + 0.5 * encoder)
        << joint.name;
  }
}

// -- The error of the wrench, against a model of its own ------------------------------------------

/// An arm at rest or in slow motion, frame by frame: nothing of it is the estimator's code.
class SlowArm {
 public:
  SlowArm(const Cell& cell, const std::vector<sim::DriveFriction>& drawn, const JointVector& start)
      : cell_(cell), position_(start) {
    for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
      friction_.emplace_back(cell.robot.joints[i], drawn[i], start[i]);
    }
  }

  /// @param wrench on the tool, task axes about its tip
  ArmFeedback step(const JointVector& velocity, const Vector6& wrench) {
    ArmFeedback feedback;
    const double cycle_s = 1e-6 * cell_.robot.cycle_us;
    for (std::size_t i = 0; i < friction_.size(); ++i) {
      position_[i] += cycle_s * velocity[i];
      friction_[i].update(position_[i], velocity[i]);
    }
    for (std::size_t i = 0; i < friction_.size(); ++i) {
      const Joint& joint = cell_.robot.joints[i];
      const double effort = holding(i) - felt(i, wrench) + friction_[i].effort();
      const double count = 1e-3 * joint.rated_effort;
      feedback.effort[i] = count * std::round(effort / count);
      feedback.position[i] =
          std::round(position_[i] * joint.counts_per_unit) / joint.counts_per_unit;
      feedback.joints_fresh |= 1U << i;
    }
    return feedback;
  }

  [[nodiscard]] const JointVector& position() const { return position_; }
  /// Tool in the task frame.
  [[nodiscard]] Pose tool(const JointVector& position) const {
    return compose(inverse(cell_.X_BT),
                   compose(compose(links(position).back(), cell_.robot.flange), cell_.X_FP));
  }

 private:
  [[nodiscard]] std::vector<Pose> links(const JointVector& position) const {
    std::vector<Pose> links;
    Pose X_BL;
    for (std::size_t i = 0; i < cell_.robot.joints.size(); ++i) {
      const Joint& joint = cell_.robot.joints[i];
      const bool turns = joint.kind == Joint::Kind::kRevolute;
      const Vector3 way = position[i] * joint.axis;
      const Pose moved = turns ? Pose{Vector3::Zero(), rotation_of(way)}
                               : Pose{way, Eigen::Quaterniond::Identity()};
      X_BL = compose(compose(X_BL, joint.origin), moved);
      links.push_back(X_BL);
    }
    return links;
  }
  [[nodiscard]] double potential_J(const JointVector& position) const {
    const std::vector<Pose> at = links(position);
    double energy_J = 0.0;
    const auto lift = [&](double mass_kg, const Pose& X, const Vector3& point_m) {
      energy_J += 9.80665 * mass_kg * cell_.up_B.dot(X.position_m + X.orientation * point_m);
    };
    for (std::size_t i = 0; i < at.size(); ++i) {
      lift(cell_.robot.joints[i].link.mass_kg, at[i], cell_.robot.joints[i].link.com_m);
    }
    lift(cell_.payload_mass_kg, compose(compose(at.back(), cell_.robot.flange), cell_.X_FS),
         cell_.payload_com_m);
    return energy_J;
  }
  [[nodiscard]] std::array<JointVector, 2> beside(std::size_t i) const {
    std::array<JointVector, 2> both = {position_, position_};
    both[0][i] -= kStep;
    both[1][i] += kStep;
    return both;
  }
  [[nodiscard]] double holding(std::size_t i) const {
    const auto [behind, ahead] = beside(i);
    return (potential_J(ahead) - potential_J(behind)) / (2.0 * kStep);
  }
  [[nodiscard]] double felt(std::size_t i, const Vector6& wrench) const {
    const auto [behind, ahead] = beside(i);
    return wrench.dot(displacement_between(tool(behind), tool(ahead))) / (2.0 * kStep);
  }

  static constexpr double kStep = 1e-6;
  Cell cell_;
  JointVector position_;
  std::vector<sim::FrictionState> friction_;
};

class Draws {
 public:
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1.0p-53;
  }

 private:
  std::mt19937_64 random_{11};
};

/// Joints whose tool is well off singularities.
JointVector good_pose(const Cell& cell, Draws& draw) {
  const TorqueMap map(cell);
  for (;;) {
    JointVector joints{};
    for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
      const Joint& joint = cell.robot.joints[i];
      joints[i] = draw(0.8 * joint.lower, 0.8 * joint.upper);
    }
    if (cell.robot.joints.size() < 6) return joints;
    const TorqueMap::At at = map.at(joints);
    const Eigen::JacobiSVD<TorqueMap::ToWrench> svd(at.jacobian);
    if (svd.singularValues()[5] > 0.05 * svd.singularValues()[0]) return joints;
  }
}

struct Measured {
  std::vector<double> errors[6];
  std::vector<double> resolutions[6];
  int beyond = 0;
  int all = 0;
};

/// At rest, tared, moved there and back, then pushed while it goes on.
void measure(const Cell& cell, const std::vector<sim::DriveFriction>& drawn, Draws& draw,
             Measured& measured) {
  SlowArm arm(cell, drawn, good_pose(cell, draw));
  JointTorqueWrench estimator(cell);
  const TorqueMap map(cell);
  const auto go = [&](const JointVector& velocity, const Vector6& wrench, int cycles) {
    Vector6 felt = Vector6::Zero();
    for (int i = 0; i < cycles; ++i) {
      ArmFeedback feedback = arm.step(velocity, wrench);
      estimator.feel(feedback);
      felt = feedback.wrench;
    }
    return felt;
  };
  const Vector6 none = Vector6::Zero();
  const Vector6 zero = estimator.settle(go({}, none, 200));
  JointVector velocity{};
  for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) velocity[i] = draw(-0.05, 0.05);
  for (int leg = 0; leg < 3; ++leg) {
    for (double& speed : velocity) speed = -draw(0.5, 1.5) * speed;
    (void)go(velocity, none, 500);
  }
  Vector6 wrench;
  for (int axis = 0; axis < 6; ++axis) wrench[axis] = axis < 3 ? draw(-20, 20) : draw(-4, 4);
  if (cell.robot.joints.size() < 6) wrench.tail<3>().setZero();
  const Vector6 felt = go(velocity, wrench, 100) - zero;
  const Eigen::Quaterniond to_task = arm.tool(arm.position()).orientation;
  Vector6 found;
  found << to_task * felt.head<3>(), to_task * felt.tail<3>();
  const Vector6 resolution =
      TorqueMap::resolution(map.at(arm.position()), effort_uncertainty(cell));
  for (int axis = 0; axis < 6; ++axis) {
    if (!std::isfinite(resolution[axis])) continue;
    measured.errors[axis].push_back(std::abs(found[axis] - wrench[axis]));
    measured.resolutions[axis].push_back(resolution[axis]);
    ++measured.all;
    measured.beyond += measured.errors[axis].back() > resolution[axis] ? 1 : 0;
  }
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

struct ErrorCase {
  const char* cell = "";
  int poses = 0;               ///< with each of three payloads
  std::vector<double> shares;  ///< of friction in the rated effort
};

// NOLINTNEXTLINE(readability-identifier-naming): googletest's name
void PrintTo(const ErrorCase& error, std::ostream* out) { *out << error.cell; }

class WrenchErrorOf : public ::testing::TestWithParam<ErrorCase> {};
// The identification of six axes takes the time; a release looks at all of it.
INSTANTIATE_TEST_SUITE_P(Tree, WrenchErrorOf,
                         ::testing::Values(ErrorCase{"gantry3", 30, {0.02, 0.10}},
                                           ErrorCase{"csp6_peg", 10, {0.02}}),
                         [](const auto& error) { return std::string(error.param.cell); });
INSTANTIATE_TEST_SUITE_P(Full, WrenchErrorOf,
                         ::testing::Values(ErrorCase{"gantry3", 100, {0.02, 0.10}},
                                           ErrorCase{"csp6_peg", 100, {0.02, 0.10}}),
                         [](const auto& error) { return std::string(error.param.cell); });

TEST_P(WrenchErrorOf, IsWithinTheStatedResolutionOverPosesAnd3Payloads) {
  for (const double share : GetParam().shares) {
    const sim::WorldDraw world = rough_world(share, share, 7);
    Cell cell = torque_cell(GetParam().cell);
    const auto friction = identified(cell, world);
    ASSERT_EQ(friction.status, executor::FrictionIdentification::Status::kIdentified);
    cell.joint_torque->joints = friction.joints;
    Draws draw;
    Measured measured;
    for (const double payload_kg : {0.0, 1.0, 3.0}) {
      cell.payload_mass_kg = payload_kg;
      for (int pose = 0; pose < GetParam().poses; ++pose)
        measure(cell, world.drive_friction, draw, measured);
    }
    std::printf("%s, friction %.0f %% of rated, %zu poses:\n", GetParam().cell, 100.0 * share,
                measured.errors[0].size());
    for (int axis = 0; axis < 6; ++axis) {
      if (measured.errors[axis].empty()) continue;
      std::printf("  %d: error p50 %.3g p95 %.3g, resolution p50 %.3g p95 %.3g\n", axis,
                  percentile(measured.errors[axis], 0.5), percentile(measured.errors[axis], 0.95),
                  percentile(measured.resolutions[axis], 0.5),
                  percentile(measured.resolutions[axis], 0.95));
    }
    std::printf("  beyond the resolution: %d of %d\n", measured.beyond, measured.all);
    EXPECT_LE(measured.beyond, measured.all / 50);
  }
}

}  // namespace
}  // namespace tenon::tests
