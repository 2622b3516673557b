#pragma once
// One motor in MIT mode: frames to the joint's SI units and back, and what it is sent next.
// Real-time, no clock, no I/O; one thread; owns its memory.
//
// A motor has no profile of its own: the position that it is sent acts at once. Its velocity comes
// from the setpoints before and after, so that the motor's damping does not hold it back. It has no
// integral part either: what gravity asks for is sent as torque, and what is left of the error is
// brought to nothing by an integral part here, slow beside the motor's own spring and damper:
//
//   torque = gravity + I,   I' = kp / T_i (setpoint - position)

#include <cstdint>
#include <optional>

#include "hw/mit/motor_frames.h"
#include "shared/cell/robot.h"
#include "shared/mit/robot_motors.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw::mit {

class MotorChannel {
 public:
  static constexpr double kIntegralTime_s = 0.3;

  MotorChannel() = default;
  /// @param cycle_us from one update() to the next
  MotorChannel(const Joint& joint, std::uint32_t cycle_us);

  /// As before the first feedback.
  void reset();
  /// False: not this motor's feedback.
  [[nodiscard]] bool take_feedback(const CanFrame& frame);

  /// Once a cycle: what next_frame() says from now on.
  /// @param follow `setpoint` (rad), else stand where it stood as this was first asked
  /// @param gravity_Nm what holds the joint
  void update(ArmRequest request, bool follow, double setpoint, double gravity_Nm);
  /// To be sent at once where a stop is asked for, and as the next cycle begins.
  [[nodiscard]] const CanFrame& next_frame() const { return next_; }
  /// Whether a setpoint (rad) is a number.
  [[nodiscard]] static bool is_target(double setpoint);

  [[nodiscard]] std::uint8_t node() const { return node_; }
  [[nodiscard]] std::uint32_t feedback_id() const { return motor_.feedback_id; }
  [[nodiscard]] bool seen() const { return seen_; }                     ///< since reset()
  [[nodiscard]] std::uint8_t state() const { return feedback_.state; }  ///< of shared/mit
  [[nodiscard]] bool on() const;
  [[nodiscard]] bool faulty() const;
  [[nodiscard]] double position() const;  ///< rad
  [[nodiscard]] double effort() const;    ///< Nm
  /// Whether it has been on since it was last asked to be so.
  [[nodiscard]] bool reached_on() const { return reached_on_; }

 private:
  [[nodiscard]] MotorCommand hold(double setpoint, double velocity, double gravity_Nm);

  std::uint8_t node_ = 0;
  MitMotor motor_;
  double sign_ = 1.0;        ///< of the motor against the joint
  double offset_rad_ = 0.0;  ///< of the motor where the joint is at 0
  double effort_max_ = 0.0;
  double cycle_s_ = 1.0;

  bool seen_ = false;
  bool reached_on_ = false;
  MotorFeedback feedback_;
  std::optional<double> held_;  ///< where it stands; unset: it follows, or has no power
  double sent_ = 0.0;           ///< the last setpoint, rad
  double integral_Nm_ = 0.0;
  CanFrame next_;
};

}  // namespace tenon::hw::mit
