#include "executor/motion/stop_profile.h"

#include <algorithm>
#include <limits>

namespace tenon::executor {
namespace {

// The tighter of a translation's and a rotation's limit, for a motion scaled to speed 1.
double scaled(double limit, double speed, double angular_limit, double angular_speed) {
  double most = std::numeric_limits<double>::infinity();
  if (speed > kRest) most = limit / speed;
  if (angular_speed > kRest) most = std::min(most, angular_limit / angular_speed);
  return most;
}

}  // namespace

StopProfile::StopProfile(const GuardedMove::Setpoint& moving, const SpeedLimits& limits)
    : start_(moving) {
  const double speed = moving.velocity.head<3>().norm();
  const double turn = moving.velocity.tail<3>().norm();
  if (speed <= kRest && turn <= kRest) {
    start_.velocity.setZero();
    return;
  }
  const double slope = moving.acceleration.dot(moving.velocity) / moving.velocity.squaredNorm();
  ramp_ = StopRamp(slope, scaled(limits.acceleration_mps2, speed, limits.acceleration_radps2, turn),
                   scaled(limits.jerk_mps3, speed, limits.jerk_radps3, turn));
}

GuardedMove::Setpoint StopProfile::at(double time_s) const {
  const StopRamp::Sample sample = ramp_.at(time_s);
  GuardedMove::Setpoint setpoint;
  setpoint.pose = displaced(start_.pose, start_.velocity * sample.covered_s);
  if (time_s < ramp_.duration_s()) {
    setpoint.velocity = start_.velocity * sample.share;
    setpoint.acceleration = start_.velocity * sample.slope;
  }
  return setpoint;
}

}  // namespace tenon::executor
