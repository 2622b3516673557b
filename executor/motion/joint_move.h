#pragma once
// A move of all joints together, straight from one set of positions to another: they start and stop
// at the same time, and the tool is nowhere faster than it may be at a contact. Joint limits are
// boxes, so a way between two positions inside them stays inside. It knows nothing of obstacles.
// Real-time: built in bounded time (kinematics at kSamples points), no allocation.

#include "executor/motion/tool_kinematics.h"
#include "shared/cell/robot.h"
#include "shared/motion/motion_profile.h"
#include "shared/motion/move_parameters.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

class JointMove {
 public:
  /// Of each joint's speed_max and acceleration_max: nobody has planned this way.
  static constexpr double kCaution = 0.25;
  /// The acceleration builds up over this time, s.
  static constexpr double kRampTime_s = 0.1;
  /// Points of the way at which the tool's speed is taken.
  static constexpr int kSamples = 64;

  JointMove() = default;
  /// @param tool its contact speeds bound the tool
  JointMove(const JointVector& from, const JointVector& to, const Robot& robot,
            const ToolKinematics& kinematics, const SpeedLimits& tool);

  [[nodiscard]] JointVector at(double time_s) const;
  [[nodiscard]] double duration_s() const { return profile_.duration_s(); }

 private:
  JointVector from_{};
  JointVector way_{};
  MotionProfile profile_;  ///< share of the way, 0 to 1
};

}  // namespace tenon::executor
