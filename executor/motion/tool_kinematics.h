#pragma once
// The tool in the task frame from joint positions, and back: a robot's chain with a cell's
// calibration around it. Real-time after construction; owns all it needs.

#include <cstdint>

#include "shared/cell/cell.h"
#include "shared/kinematics/serial_chain.h"

namespace tenon::executor {

class ToolKinematics {
 public:
  /// @throws InputError for a robot without joints.
  explicit ToolKinematics(const Cell& cell);

  [[nodiscard]] const SerialChain& chain() const { return chain_; }

  /// X_TP, tool in task frame.
  [[nodiscard]] Pose tool(const JointVector& position) const;
  /// X_BF, the flange in the base frame, for a tool pose.
  [[nodiscard]] Pose flange_for(const Pose& tool) const;

  /// Joints that bring the tool to a pose; only the robot's own axes count (a gantry's orientation
  /// is what it is). @param parameters its axes are ignored
  [[nodiscard]] SerialChain::Inverse joints(const Pose& tool, const JointVector& seed,
                                            SerialChain::InverseParameters parameters = {}) const;

  /// Twist of the tool in task axes at the tool tip, a column per joint.
  [[nodiscard]] SerialChain::Jacobian jacobian(const JointVector& position) const;
  /// The same for joint speeds that are given, m/s and rad/s.
  [[nodiscard]] Vector6 twist(const JointVector& position, const JointVector& velocity) const;
  /// Joint speeds for a twist of the tool in task axes, the least that make it.
  [[nodiscard]] JointVector rates(const JointVector& position, const Vector6& twist) const;

  /// How far the arm is from a singularity: smallest over largest singular value of the tool's
  /// Jacobian along the robot's own axes, where kLever_m of translation counts like a radian. 0 is
  /// singular, 1 the best there is.
  [[nodiscard]] double conditioning(const JointVector& position) const;
  static constexpr double kLever_m = 0.3;

  /// Axes of the base frame that count in joints().
  [[nodiscard]] std::uint8_t axes() const { return axes_; }
  /// The middle of every joint's range.
  [[nodiscard]] const JointVector& middle() const { return middle_; }

 private:
  [[nodiscard]] SerialChain::Jacobian tip_jacobian_B(const JointVector& position) const;

  SerialChain chain_;
  Pose X_TB_;
  Pose X_BT_;
  Pose X_FP_;
  Pose X_PF_;
  JointVector middle_{};
  std::uint8_t axes_ = SerialChain::kAllAxes;
};

}  // namespace tenon::executor
