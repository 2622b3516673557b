#pragma once
// Brings a moving setpoint to rest along its own line with bounded acceleration and jerk, from
// whatever velocity and acceleration it has. Knows nothing of contacts. Real-time: built in
// constant time, no allocation.

#include "executor/motion/stop_ramp.h"
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
  [[nodiscard]] double duration_s() const { return ramp_.duration_s(); }

 private:
  GuardedMove::Setpoint start_;
  StopRamp ramp_;
};

}  // namespace tenon::executor
