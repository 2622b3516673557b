#include "shared/joint_torque/torque_map.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <string>

#include "shared/base/text.h"

namespace tenon {
namespace {

// Of the largest that there is: what the arm hardly resolves is left out, not blown up.
constexpr double kDampingSquared = 1e-6;

}  // namespace

TorqueMap::TorqueMap(const Cell& cell)
    : chain_(cell.robot), X_TB_(inverse(cell.X_BT)), X_FP_(cell.X_FP) {}

Pose TorqueMap::tool(const JointVector& position) const {
  return compose(compose(X_TB_, chain_.flange(position)), X_FP_);
}

TorqueMap::At TorqueMap::at(const JointVector& position) const noexcept {
  At at;
  const SerialChain::Jacobian flange = chain_.jacobian(position);
  const Vector3 to_tip_m = chain_.flange(position).orientation * X_FP_.position_m;
  const Eigen::Matrix3d R_TB = X_TB_.orientation.toRotationMatrix();
  for (int i = 0; i < static_cast<int>(chain_.joint_count()); ++i) {
    const Vector3 turn = flange.col(i).tail<3>();
    const Vector3 way = flange.col(i).head<3>() + turn.cross(to_tip_m);
    at.jacobian.col(i) << R_TB * way, R_TB * turn;
  }
  // In N and in Nm over the lever, which are alike.
  Vector6 scale;
  scale << 1.0, 1.0, 1.0, Vector3::Constant(kLever_m);
  const ToWrench scaled = scale.asDiagonal() * at.jacobian;
  Eigen::Matrix<double, 6, 6> normal = scaled * scaled.transpose();
  normal.diagonal().array() += kDampingSquared * normal.trace();
  at.to_wrench = scale.asDiagonal() * normal.ldlt().solve(scaled);
  const Vector6 share = (at.to_wrench * at.jacobian.transpose()).diagonal();
  for (int axis = 0; axis < 6; ++axis) {
    if (share[axis] >= kShareLeast) at.axes |= static_cast<std::uint8_t>(1U << axis);
  }
  return at;
}

Vector6 TorqueMap::resolution(const At& at, const JointVector& effort) noexcept {
  const Eigen::Map<const Eigen::Matrix<double, static_cast<int>(kMaxJoints), 1>> off(effort.data());
  Vector6 resolution = at.to_wrench.cwiseAbs() * off;
  for (int axis = 0; axis < 6; ++axis) {
    if ((at.axes >> axis & 1U) == 0) resolution[axis] = std::numeric_limits<double>::infinity();
  }
  return resolution;
}

JointVector effort_uncertainty(const Cell& cell) {
  JointVector effort{};
  for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
    const bool known = cell.joint_torque && i < cell.joint_torque->joints.size();
    effort[i] = known ? cell.joint_torque->joints[i].residual : cell.robot.joints[i].rated_effort;
  }
  return effort;
}

std::string resolution_text(const Vector6& resolution) {
  std::string text;
  std::string rest;
  for (int axis = 0; axis < 6; ++axis) {
    if (std::isfinite(resolution[axis])) {
      text += format("%s%s %.3g %s", text.empty() ? "" : ", ", axis_name(axis), resolution[axis],
                     axis < 3 ? "N" : "Nm");
    } else {
      rest += std::string(" ") + axis_name(axis);
    }
  }
  if (text.empty()) text = "nothing";
  return rest.empty() ? text : text + "; not:" + rest;
}

}  // namespace tenon
