#pragma once
// What a task calls success.

#include "shared/math/pose.h"
#include "shared/task/task.h"

namespace tenon {

/// Whether a tool tip stands where the task wants it inserted; always where it does not say.
[[nodiscard]] bool inserted(const Task& task, const Pose& tool);

/// How far from the goal a tool stands, in its tolerances: see shared/plan/goal_axes.h. Rotations
/// that are not the task's coordinates do not count.
[[nodiscard]] double tolerances_from_goal(const Task& task, const Pose& tool);

/// Whether that is at most one.
[[nodiscard]] bool within_tolerance(const Task& task, const Pose& tool);

}  // namespace tenon
