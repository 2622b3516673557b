#pragma once
// The wrench of an arm without a force/torque sensor, from what its drives report of their efforts:
// less what gravity, inertia and friction take of it, by the transpose of the Jacobian at the tool
// tip (shared/joint_torque/torque_map.h). Inertia goes by the encoders and never by the command:
// what a drive reports and how its joint moved are of one time, so that a compliant tool does not
// answer to its own inertia. That is what a momentum observer does (De Luca, Mattone 2003). It
// takes the place of the sensor's reading in the arm's feedback, in the tool's axes about the tip,
// without weight. What it cannot know is how friction stands after a rest: the tare tells, since
// nothing touches then. Real-time but for the constructor; one thread.

#include <array>
#include <cstdint>

#include "shared/cell/cell.h"
#include "shared/joint_torque/torque_map.h"
#include "shared/kinematics/inverse_dynamics.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

/// The cell as whoever takes that wrench for a sensor's has to see it: measured at the tip, nothing
/// hanging from it. Of a cell with a sensor, the cell.
[[nodiscard]] Cell sensed_cell(Cell cell);

class JointTorqueWrench {
 public:
  /// @param cell with joint_torque; not sensed_cell()
  explicit JointTorqueWrench(const Cell& cell);

  /// Once a cycle: puts the wrench into the feedback, fresh where every joint has answered.
  void feel(ArmFeedback& feedback) noexcept;
  /// Nothing touches: what is left over is friction that came to rest as nobody saw, as far as it
  /// can be. @param mean of the wrench since the joints have rested  @return what it would be now
  [[nodiscard]] Vector6 settle(const Vector6& mean) noexcept;

  /// Efforts less gravity, inertia and friction, a joint each; not filtered. Of the two cycles
  /// before the last answer, whose middle is a cycle old.
  [[nodiscard]] const JointVector& external() const noexcept { return external_; }
  /// The same with friction: what an identification looks at.
  [[nodiscard]] const JointVector& rubbing() const noexcept { return rubbing_; }
  /// Of the joints, m/s or rad/s.
  [[nodiscard]] const JointVector& velocity() const noexcept { return velocity_; }

 private:
  void take_off(const ArmFeedback& feedback) noexcept;
  [[nodiscard]] Eigen::Quaterniond R_PT() const noexcept;

  std::size_t count_;
  double cycle_s_;
  std::array<JointFriction, kMaxJoints> friction_{};
  InverseDynamics dynamics_;
  TorqueMap map_;

  int known_ = 0;        ///< cycles in which every joint has answered, as far as they are asked for
  int cycles_ = 0;       ///< since the last cycle in which every joint answered
  double before_s_ = 0;  ///< from the answer before to the last
  TorqueMap::At at_;
  JointVector position_{};
  JointVector speed_{};     ///< mean since the answer before
  JointVector velocity_{};  ///< smoothed
  JointVector effort_{};    ///< as reported
  JointVector z_{};         ///< friction's memory
  JointVector z_gear_{};    ///< hysteresis's
  JointVector rubbing_{};
  JointVector external_{};
  Vector6 filtered_ = Vector6::Zero();  ///< task axes
  bool filtering_ = false;
  std::uint16_t counter_ = 0;
};

}  // namespace tenon::executor
