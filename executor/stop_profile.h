#pragma once
// Brings a moving setpoint to rest along its own line with bounded acceleration and jerk, from
// whatever velocity and acceleration it has. Knows nothing of contacts. Real-time: built in
// constant time, no allocation.

#include <array>

#include "shared/motion/guarded_move.h"
#include "shared/motion/move_parameters.h"

namespace tenon::executor {

class StopProfile {
 public:
  StopProfile() = default;
  /// @param moving its velocity and acceleration are taken as parallel
  StopProfile(const GuardedMove::Setpoint& moving, const SpeedLimits& limits);

  /// @param time_s since the stop began; from duration_s() on it rests.
  [[nodiscard]] GuardedMove::Setpoint at(double time_s) const;
  [[nodiscard]] double duration_s() const { return duration_s_; }

 private:
  struct Segment {
    double duration_s = 0.0;
    double jerk = 0.0;
  };
  GuardedMove::Setpoint start_;
  double slope_ = 0.0;  ///< at the start, of the share of the velocity that is left, 1/s
  std::array<Segment, 3> segments_{};
  double duration_s_ = 0.0;
};

}  // namespace tenon::executor
