#include "executor/stop_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenon::executor {
namespace {

// Slower than this (m/s, rad/s) is rest.
constexpr double kRest = 1e-9;

// The tighter of a translation's and a rotation's limit, for a motion scaled to speed 1.
double scaled(double limit, double speed, double angular_limit, double angular_speed) {
  double most = std::numeric_limits<double>::infinity();
  if (speed > kRest) most = limit / speed;
  if (angular_speed > kRest) most = std::min(most, angular_limit / angular_speed);
  return most;
}

}  // namespace

// With u(t) the share of the starting velocity that is left: u = 1, u' = slope at the start, and
// u = u' = 0 at the end. First u'' = -j down to u' = -peak, then u'' = 0, then u'' = +j.
StopProfile::StopProfile(const GuardedMove::Setpoint& moving, const SpeedLimits& limits)
    : start_(moving) {
  const double speed = moving.velocity.head<3>().norm();
  const double turn = moving.velocity.tail<3>().norm();
  if (speed <= kRest && turn <= kRest) {
    start_.velocity.setZero();
    return;
  }
  slope_ = moving.acceleration.dot(moving.velocity) / moving.velocity.squaredNorm();
  const double slope_max =
      scaled(limits.acceleration_mps2, speed, limits.acceleration_radps2, turn);
  double jerk = scaled(limits.jerk_mps3, speed, limits.jerk_radps3, turn);
  double peak = std::min(slope_max, std::sqrt(jerk + 0.5 * slope_ * slope_));
  if (peak < -slope_) {
    // Braking harder than the limits already: end this braking with the jerk that comes out at
    // rest.
    peak = -slope_;
    jerk = std::max(jerk, 0.5 * peak * peak);
  }
  const double down_s = (slope_ + peak) / jerk;
  const double up_s = peak / jerk;
  const double ramps = (slope_ * slope_ - 2.0 * peak * peak) / (2.0 * jerk);
  const double hold_s = std::max(0.0, (1.0 + ramps) / peak);
  segments_ = {{{down_s, -jerk}, {hold_s, 0.0}, {up_s, jerk}}};
  duration_s_ = down_s + hold_s + up_s;
}

GuardedMove::Setpoint StopProfile::at(double time_s) const {
  double covered = 0.0;
  double share = 1.0;
  double slope = slope_;
  double left_s = std::clamp(time_s, 0.0, duration_s_);
  for (const Segment& segment : segments_) {
    const double t = std::min(left_s, segment.duration_s);
    covered += t * (share + t * (0.5 * slope + t * segment.jerk / 6.0));
    share += t * (slope + 0.5 * t * segment.jerk);
    slope += t * segment.jerk;
    left_s -= t;
  }
  GuardedMove::Setpoint setpoint;
  setpoint.pose = displaced(start_.pose, start_.velocity * covered);
  if (time_s < duration_s_) {
    setpoint.velocity = start_.velocity * share;
    setpoint.acceleration = start_.velocity * slope;
  }
  return setpoint;
}

}  // namespace tenon::executor
