#pragma once
// A cell and plans made by hand, small enough to foresee what must happen.

#include <initializer_list>
#include <utility>

#include "shared/cell/cell.h"
#include "shared/plan/plan.h"

namespace tenon::executor {

/// A three-axis gantry, 2 ms, one cycle of delay and nothing else. Base, task, flange and sensor
/// frames are all turned against each other; the tool's orientation in the task frame is identity.
[[nodiscard]] Cell hand_made_cell();

/// A six-axis arm (the kinematics and limits of a Schunk LWA 4P, 2 ms) that stands on its base with
/// its tool pointing down: task axes are those of the base, the task frame lies 0.40 m in front of
/// it and 0.05 m above its foot, the tool's orientation in the task frame is identity.
[[nodiscard]] Cell hand_made_arm_cell();

/// A step along one translation axis. @param ways what each named outcome leads to
[[nodiscard]] Step hand_made_step(int axis, double displacement_m,
                                  std::initializer_list<std::pair<Outcome, Successor>> ways);

/// No steps yet; starts at (0.1, 0, 0). Envelopes are as hand_made_step() leaves them.
[[nodiscard]] Plan hand_made_plan();

/// Wall at x = 0.13 expected: +x to contact, then +y by 0.04 to the end.
[[nodiscard]] Plan touch_and_slide_plan();
/// The same where the hand-made six-axis arm has room for it.
[[nodiscard]] Plan arm_plan();

}  // namespace tenon::executor
