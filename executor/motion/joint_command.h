#pragma once
// The commanded joints. They follow a tool pose or joint positions cycle by cycle, and never jump:
// a command that has no joint positions near the last one, moves a joint faster than its speed_max,
// or leaves it no room to stop before its limit is not taken but named. What is left then is to
// ramp down, for which the last command taken has the room. Real-time, one thread, no allocation.

#include <optional>

#include "executor/motion/joint_stop.h"
#include "executor/motion/tool_kinematics.h"
#include "executor/states/ending.h"
#include "shared/cell/cell.h"

namespace tenon::executor {

class JointCommand {
 public:
  /// @param kinematics outlives this
  JointCommand(const Robot& robot, const ToolKinematics& kinematics);

  void rest_at(const JointVector& position);

  /// One cycle. @return why the command was not taken; the joints then stand as they stood
  [[nodiscard]] std::optional<Ending> follow(const Pose& tool);
  [[nodiscard]] std::optional<Ending> follow(const JointVector& position);

  /// From now on ramp() brings the joints to rest.
  void stop();
  /// One cycle of that.
  void ramp();
  [[nodiscard]] bool at_rest() const { return stop_time_s_ >= stop_.duration_s(); }

  [[nodiscard]] const JointVector& position() const { return position_; }
  /// Over the last cycle, m/s or rad/s.
  [[nodiscard]] const JointVector& velocity() const { return velocity_; }

 private:
  [[nodiscard]] JointVector velocity_to(const JointVector& next) const;

  Robot robot_;
  const ToolKinematics& kinematics_;
  double cycle_s_;
  JointVector position_{};
  JointVector velocity_{};
  JointStop stop_;
  double stop_time_s_ = 0.0;
};

}  // namespace tenon::executor
