#pragma once
// The tool as the compliance law commands it: what position-controlled drives are to follow, and
// where a guarded move may take the tool to be. Real-time, one thread, no allocation.

#include "shared/math/pose.h"
#include "shared/motion/admittance.h"
#include "shared/motion/move_parameters.h"
#include "shared/motion/setpoint.h"

namespace tenon::executor {

class CommandedTool {
 public:
  explicit CommandedTool(const Compliance& compliance) : law_(compliance) {}

  void rest_at(const Pose& pose) { law_.reset({pose}); }

  /// One cycle. @param wrench external, task axes at the tool tip, N and Nm  @param cycle_s > 0
  /// @return the tool as commanded, in the task frame
  const Admittance::State& update(const Setpoint& setpoint, const Vector6& wrench, double cycle_s) {
    return law_.update(setpoint, wrench, cycle_s);
  }
  [[nodiscard]] const Admittance::State& commanded() const { return law_.state(); }

  /// The pose for a guarded move. Axes that yield are measured. On the others the tool is where it
  /// was told to be: were the measured pose taken there, each move would start by a following error
  /// off its predecessor's end.
  [[nodiscard]] Pose seen(const Pose& measured) const {
    const Pose& commanded = law_.state().pose;
    Vector6 off = displacement_between(commanded, measured);
    for (int axis = 0; axis < 6; ++axis) {
      if (!law_.yields(axis)) off[axis] = 0.0;
    }
    return displaced(commanded, off);
  }

 private:
  Admittance law_;
};

}  // namespace tenon::executor
