#include "executor/motion/joint_stop.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenon::executor {

JointStop::JointStop(const JointVector& position, const JointVector& velocity, const Robot& robot)
    : position_(position), velocity_(velocity) {
  double slope = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const double speed = std::abs(velocity[i]);
    if (speed > kRest) slope = std::min(slope, robot.joints[i].acceleration_max / speed);
  }
  if (std::isfinite(slope)) {
    ramp_ = StopRamp(0.0, slope, slope / kRampTime_s);
  } else {
    velocity_ = {};
  }
}

JointVector JointStop::at(double time_s) const {
  const double covered_s = ramp_.at(time_s).covered_s;
  JointVector position = position_;
  for (std::size_t i = 0; i < kMaxJoints; ++i) position[i] += velocity_[i] * covered_s;
  return position;
}

}  // namespace tenon::executor
