#pragma once
// How fast a move's own time runs against the clock's: 1, or on the way to 0 and back while the
// user has paused it. What comes of a pause on top of a move's own acceleration and jerk is at most
// half of their limits. Real-time, one thread.

#include <algorithm>
#include <cmath>
#include <limits>

#include "shared/motion/move_parameters.h"

namespace tenon::executor {

class Pace {
 public:
  /// One cycle on. @param paused whether it is to come to 0  @param limits of the move
  void update(bool paused, const SpeedLimits& limits, double cycle_s) {
    const double goal = paused ? 0.0 : 1.0;
    const double left = goal - share_;
    const double most_rate = most(limits.acceleration_mps2, limits.approach_mps,
                                  limits.acceleration_radps2, limits.approach_radps);
    const double most_slope =
        most(limits.jerk_mps3, limits.approach_mps, limits.jerk_radps3, limits.approach_radps);
    // As fast as it can still come to rest at its goal.
    const double wanted =
        std::copysign(std::min(most_rate, std::sqrt(2.0 * most_slope * std::abs(left))), left);
    const double step = most_slope * cycle_s;
    rate_ = std::clamp(wanted, rate_ - step, rate_ + step);
    const bool arrives = std::abs(left) <= std::abs(rate_) * cycle_s + kArrived;
    share_ = arrives ? goal : std::clamp(share_ + rate_ * cycle_s, 0.0, 1.0);
    if (arrives) rate_ = 0.0;
  }

  /// Of full speed, 0..1.
  [[nodiscard]] double share() const { return share_; }
  /// Its change, 1/s.
  [[nodiscard]] double rate() const { return rate_; }

 private:
  static constexpr double kArrived = 1e-6;

  static double most(double limit, double speed, double angular_limit, double angular_speed) {
    double least = std::numeric_limits<double>::infinity();
    if (speed > 0.0) least = limit / speed;
    if (angular_speed > 0.0) least = std::min(least, angular_limit / angular_speed);
    return 0.5 * least;
  }

  double share_ = 1.0;
  double rate_ = 0.0;
};

}  // namespace tenon::executor
