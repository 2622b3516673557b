#include "shared/mit/robot_motors.h"

#include <any>

namespace tenon {

bool speaks_mit(const Robot& robot) {
  return !robot.joints.empty() && std::any_cast<MitMotor>(&robot.joints.front().drive) != nullptr;
}

const MitMotor& mit_motor(const Joint& joint) {
  static const MitMotor kUnsaid;
  const auto* motor = std::any_cast<MitMotor>(&joint.drive);
  return motor == nullptr ? kUnsaid : *motor;
}

}  // namespace tenon
