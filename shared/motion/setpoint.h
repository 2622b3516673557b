#pragma once
// Where the admittance law is to bring the tool.

#include "shared/math/pose.h"

namespace tenon {

/// Velocity and acceleration are means over the step that leads to the pose, so that a plant which
/// takes steps of that length and meets nothing is at the pose after it.
struct Setpoint {
  Pose pose;
  Vector6 velocity = Vector6::Zero();      ///< m/s, rad/s
  Vector6 acceleration = Vector6::Zero();  ///< m/s^2, rad/s^2
};

}  // namespace tenon
