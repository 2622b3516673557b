#include "executor/tool_kinematics.h"

namespace tenon::executor {

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
                                            double limit_margin, bool respect_limits) const {
  SerialChain::InverseParameters parameters;
  parameters.axes = axes_;
  parameters.limit_margin = limit_margin;
  parameters.respect_limits = respect_limits;
  return chain_.inverse(flange_for(tool), seed, parameters);
}

SerialChain::Jacobian ToolKinematics::jacobian(const JointVector& position) const {
  SerialChain::Jacobian J = chain_.jacobian(position);
  const Vector3 to_tip_m = chain_.flange(position).orientation * X_FP_.position_m;
  const Eigen::Matrix3d R_TB = X_TB_.orientation.toRotationMatrix();
  for (int i = 0; i < static_cast<int>(chain_.joint_count()); ++i) {
    const Vector3 turn = J.col(i).tail<3>();
    const Vector3 slide = J.col(i).head<3>() + turn.cross(to_tip_m);
    J.col(i) << R_TB * slide, R_TB * turn;
  }
  return J;
}

}  // namespace tenon::executor
