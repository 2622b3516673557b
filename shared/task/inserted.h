#pragma once
// A task's own predicate of success.

#include "shared/math/pose.h"
#include "shared/task/task.h"

namespace tenon {

/// Whether a tool tip stands where the task wants it inserted; always where it does not say.
[[nodiscard]] bool inserted(const Task& task, const Pose& tool);

}  // namespace tenon
