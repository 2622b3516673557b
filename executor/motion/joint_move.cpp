#include "executor/motion/joint_move.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenon::executor {
namespace {

// Shorter ways, m or rad, are none.
constexpr double kNoMotion = 1e-9;

JointVector between(const JointVector& from, const JointVector& way, double share) {
  JointVector position = from;
  for (std::size_t i = 0; i < kMaxJoints; ++i) position[i] += share * way[i];
  return position;
}

}  // namespace

JointMove::JointMove(const JointVector& from, const JointVector& to, const Robot& robot,
                     const ToolKinematics& kinematics, const SpeedLimits& tool)
    : from_(from) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  MotionProfile::Parameters p;
  p.length = 1.0;
  p.slow_speed = p.acceleration = kNone;
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    way_[i] = to[i] - from[i];
    const double way = std::abs(way_[i]);
    if (way <= kNoMotion) continue;
    p.slow_speed = std::min(p.slow_speed, kCaution * robot.joints[i].speed_max / way);
    p.acceleration = std::min(p.acceleration, kCaution * robot.joints[i].acceleration_max / way);
  }
  if (!std::isfinite(p.slow_speed)) {
    way_ = {};
    return;
  }
  for (int sample = 0; sample <= kSamples; ++sample) {
    const JointVector here = between(from_, way_, static_cast<double>(sample) / kSamples);
    const Vector6 twist = kinematics.twist(here, way_);
    const double way_m = twist.head<3>().norm();
    const double turn_rad = twist.tail<3>().norm();
    if (way_m > kNoMotion) p.slow_speed = std::min(p.slow_speed, tool.contact_mps / way_m);
    if (turn_rad > kNoMotion) p.slow_speed = std::min(p.slow_speed, tool.contact_radps / turn_rad);
  }
  p.fast_speed = p.slow_speed;
  p.jerk = p.acceleration / kRampTime_s;
  profile_ = MotionProfile(p);
}

JointVector JointMove::at(double time_s) const {
  return between(from_, way_, profile_.at(time_s).position);
}

}  // namespace tenon::executor
