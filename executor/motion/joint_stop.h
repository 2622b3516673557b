#pragma once
// Brings all joints to rest together, along the line that they move on: what is left to do where
// the tool's own way on has no joint positions. No joint brakes harder than its acceleration_max.
// Real-time: built in constant time, no allocation.

#include <cstddef>

#include "executor/motion/stop_ramp.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

class JointStop {
 public:
  /// The braking builds up and dies away over this time, s.
  static constexpr double kRampTime_s = 0.02;

  JointStop() = default;
  /// @param velocity m/s or rad/s
  JointStop(const JointVector& position, const JointVector& velocity, const Robot& robot);

  /// @param time_s since the stop began; from duration_s() on it rests
  [[nodiscard]] JointVector at(double time_s) const;
  [[nodiscard]] double duration_s() const { return ramp_.duration_s(); }
  /// Where the joints come to rest.
  [[nodiscard]] JointVector end() const { return at(duration_s()); }

 private:
  JointVector position_{};
  JointVector velocity_{};
  StopRamp ramp_;
};

}  // namespace tenon::executor
