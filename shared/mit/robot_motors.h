#pragma once
// What the MIT mode alone knows of a robot's joints: it travels with the robot, and none but that
// mode's own code looks into it. Position on the wire is 16 bits over twice position_max_rad: these
// are the counts of the joint.

#include <cstdint>

#include "shared/cell/robot.h"

namespace tenon {

struct MitMotor {
  std::uint32_t feedback_id = 0;  ///< MST_ID, which the motor's answers carry
  double position_max_rad = 12.5;
  double velocity_max_radps = 30.0;
  double torque_max_Nm = 10.0;
  double stiffness_Nmprad = 0.0;   ///< kp of every command
  double damping_Nmsprad = 0.0;    ///< kd of every command
  std::uint32_t watchdog_ms = 20;  ///< without a command for so long the motor stops by itself
};

/// Whether the joints of this robot are such motors; all of them are, or none is.
[[nodiscard]] bool speaks_mit(const Robot& robot);
/// Of a joint that says nothing of it: the defaults.
[[nodiscard]] const MitMotor& mit_motor(const Joint& joint);

}  // namespace tenon
