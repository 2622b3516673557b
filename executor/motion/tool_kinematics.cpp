#include "executor/motion/tool_kinematics.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>

namespace tenon::executor {
namespace {

// Keeps rates() finite at a singularity; far below what shows anywhere else.
constexpr double kDamping = 1e-12;

using JointColumn = Eigen::Matrix<double, static_cast<int>(kMaxJoints), 1>;

}  // namespace

ToolKinematics::ToolKinematics(const Cell& cell)
    : chain_(cell.robot),
      X_TB_(inverse(cell.X_BT)),
      X_BT_(cell.X_BT),
      X_FP_(cell.X_FP),
      X_PF_(inverse(cell.X_FP)) {
  // A bent arm: the middle of the range is often singular, and what a robot can do shows off it.
  JointVector bent{};
  for (std::size_t i = 0; i < chain_.joint_count(); ++i) {
    const Joint& joint = cell.robot.joints[i];
    middle_[i] = 0.5 * (joint.lower + joint.upper);
    constexpr double kOffMiddle = 0.13;
    bent[i] =
        middle_[i] + kOffMiddle * (i % 2 == 0 ? 1.0 : -1.3) * 0.5 * (joint.upper - joint.lower);
  }
  axes_ = chain_.free_axes(bent);
}

Pose ToolKinematics::tool(const JointVector& position) const {
  return compose(compose(X_TB_, chain_.flange(position)), X_FP_);
}

Pose ToolKinematics::flange_for(const Pose& tool) const {
  return compose(compose(X_BT_, tool), X_PF_);
}

SerialChain::Inverse ToolKinematics::joints(const Pose& tool, const JointVector& seed,
                                            SerialChain::InverseParameters parameters) const {
  parameters.axes = axes_;
  return chain_.inverse(flange_for(tool), seed, parameters);
}

SerialChain::Jacobian ToolKinematics::tip_jacobian_B(const JointVector& position) const {
  SerialChain::Jacobian J = chain_.jacobian(position);
  const Vector3 to_tip_m = chain_.flange(position).orientation * X_FP_.position_m;
  for (int i = 0; i < static_cast<int>(chain_.joint_count()); ++i) {
    const Vector3 turn = J.col(i).tail<3>();
    J.col(i).head<3>() += turn.cross(to_tip_m);
  }
  return J;
}

SerialChain::Jacobian ToolKinematics::jacobian(const JointVector& position) const {
  SerialChain::Jacobian J = tip_jacobian_B(position);
  const Eigen::Matrix3d R_TB = X_TB_.orientation.toRotationMatrix();
  J.topRows<3>() = (R_TB * J.topRows<3>()).eval();
  J.bottomRows<3>() = (R_TB * J.bottomRows<3>()).eval();
  return J;
}

Vector6 ToolKinematics::twist(const JointVector& position, const JointVector& velocity) const {
  return jacobian(position) * Eigen::Map<const JointColumn>(velocity.data());
}

JointVector ToolKinematics::rates(const JointVector& position, const Vector6& twist) const {
  const SerialChain::Jacobian J = jacobian(position);
  Eigen::Matrix<double, 6, 6> normal = J * J.transpose();
  normal.diagonal().array() += kDamping;
  JointVector rates{};
  Eigen::Map<JointColumn>(rates.data()) = J.transpose() * normal.ldlt().solve(twist);
  return rates;
}

double ToolKinematics::conditioning(const JointVector& position) const {
  using Square = Eigen::Matrix<double, 6, 6>;
  SerialChain::Jacobian J = tip_jacobian_B(position);
  J.topRows<3>() /= kLever_m;
  for (int axis = 0; axis < 6; ++axis) {
    if ((axes_ >> axis & 1U) == 0) J.row(axis).setZero();
  }
  // Squared singular values, smallest first. What the robot cannot do anywhere is no singularity:
  // its zeros are skipped.
  const Square squared = J * J.transpose();
  const Eigen::SelfAdjointEigenSolver<Square> solver(squared, Eigen::EigenvaluesOnly);
  const Vector6& values = solver.eigenvalues();
  return std::sqrt(std::max(0.0, values[6 - std::popcount(axes_)]) / values[5]);
}

}  // namespace tenon::executor
