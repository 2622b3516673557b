#pragma once
// What a task calls success.

#include "shared/math/pose.h"
#include "shared/task/task.h"

namespace tenon {

/// Whether a tool tip stands where the task wants it inserted; always where it does not say.
[[nodiscard]] bool inserted(const Task& task, const Pose& tool);

/// Whether a tool stands within goal_tolerance_m of the goal: its distance, and what it is turned
/// by along the task's coordinates times orientation_weight.
[[nodiscard]] bool within_tolerance(const Task& task, const Pose& tool);

}  // namespace tenon
