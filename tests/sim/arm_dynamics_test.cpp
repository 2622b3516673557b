// Motion in joint coordinates against Lagrange's equations, written out by finite differences of an
// oracle's energies.

#include "sim/cell/virtual_arm/arm_dynamics.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>
#include <vector>

#include "tests/sim/arm_bench.h"
#include "tests/sim/mechanics.h"

namespace tenon::sim {
namespace {

/// The part of the payload is with the last link, as in the oracle's arm without one.
Cell without_payload(Cell cell) {
  cell.payload_mass_kg = 0.0;
  return cell;
}

std::vector<LinkInertia> links_of(const Cell& cell) {
  std::vector<LinkInertia> links;
  for (const Joint& joint : cell.robot.joints) links.push_back(joint.link);
  return links;
}

/// d/dt (M v) - dT/dq + dV/dq where no joint accelerates.
Eigen::VectorXd load_at(const Cell& cell, const JointVector& q, const Eigen::VectorXd& v) {
  constexpr double kSmall = 1e-4;
  Eigen::VectorXd load(v.size());
  Eigen::MatrixXd rate = Eigen::MatrixXd::Zero(v.size(), v.size());
  for (Eigen::Index k = 0; k < v.size(); ++k) {
    const auto joint = static_cast<std::size_t>(k);
    const Eigen::MatrixXd slope = (mass_matrix(cell, shifted(q, joint, kSmall)) -
                                   mass_matrix(cell, shifted(q, joint, -kSmall))) /
                                  (2.0 * kSmall);
    rate += v(k) * slope;
    load(k) = gravity_effort(cell, q, joint) - 0.5 * v.dot(slope * v);
  }
  return load + rate * v;
}

TEST(ArmDynamics, MovesAsLagrangesEquationsSayUnderMotorsOfAnyImpedance) {
  const Cell cell = without_payload(six_axis_cell());
  ArmDynamics dynamics(cell.robot.joints, links_of(cell), -kGravity_mps2 * cell.up_B);
  std::mt19937_64 random(81);
  std::uniform_real_distribution<double> speed(-2.0, 2.0);
  std::uniform_real_distribution<double> decade(-1.0, 6.0);
  for (int trial = 0; trial < 30; ++trial) {
    const JointVector q = random_position(cell, random);
    JointVector speeds{};
    const auto count = static_cast<Eigen::Index>(cell.robot.joints.size());
    Eigen::VectorXd v(count);
    std::vector<JointMotor> motors(cell.robot.joints.size());
    for (std::size_t i = 0; i < motors.size(); ++i) {
      v(static_cast<Eigen::Index>(i)) = speeds[i] = speed(random);
      motors[i] = {speed(random), trial == 0 ? 0.0 : std::pow(10.0, decade(random)), 0.0};
    }
    dynamics.place(q, speeds);
    const JointVector after = dynamics.velocities_after(motors, kStep_s);

    const Eigen::MatrixXd mass = mass_matrix(cell, q);
    Eigen::VectorXd effort = -load_at(cell, q, v);
    Eigen::VectorXd ends(count);
    for (std::size_t i = 0; i < motors.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      EXPECT_NEAR(dynamics.inertia(i), mass(row, row), 1e-5 * mass(row, row)) << i;
      ends(row) = after[i];
      effort(row) += motors[i].effort_at(after[i]);
    }
    const Eigen::VectorXd missing = mass * (ends - v) / kStep_s - effort;
    EXPECT_LT(missing.norm(), 1e-4 * (1.0 + effort.norm())) << "trial " << trial;
  }
}

TEST(ArmDynamics, ALinkIsWhereItsJointsHaveIt) {
  const Cell cell = without_payload(six_axis_cell());
  ArmDynamics dynamics(cell.robot.joints, links_of(cell), Vector3::Zero());
  std::mt19937_64 random(82);
  const JointVector q = random_position(cell, random);
  JointVector speeds{};
  for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) speeds[i] = 0.3 * double(i) - 0.7;
  dynamics.place(q, speeds);
  constexpr double kSmall_s = 1e-6;
  JointVector later = q;
  for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) later[i] += kSmall_s * speeds[i];
  const std::vector<Body> here = bodies_at(cell, q);
  const std::vector<Body> there = bodies_at(cell, later);
  for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
    const BodyState link = dynamics.link(i);
    EXPECT_LT((link.pose.position_m - here[i].com_m).norm(), 1e-12) << i;
    EXPECT_LT((link.pose.orientation.toRotationMatrix() - here[i].rotation).norm(), 1e-12) << i;
    EXPECT_LT((link.velocity_mps - (there[i].com_m - here[i].com_m) / kSmall_s).norm(), 1e-5) << i;
    const Eigen::AngleAxisd turn(there[i].rotation * here[i].rotation.transpose());
    EXPECT_LT((link.omega_radps - turn.angle() * turn.axis() / kSmall_s).norm(), 1e-5) << i;
  }
}

}  // namespace
}  // namespace tenon::sim
