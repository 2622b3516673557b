#pragma once
// Whether the sizes of a task can be metres. Pure; any thread.

#include <vector>

#include "planner/check/task_check.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// Doubts about parts that no arm holds, and about a part that is not where the tool is.
[[nodiscard]] std::vector<Finding> doubtful_sizes(const Task& task);

}  // namespace tenon::planner
