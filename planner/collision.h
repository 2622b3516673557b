#pragma once
// What stands in the way before anything moves. Pure but for the rollout that is asked.

#include <string>

#include "shared/ports/rollout.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// Empty where start, particles and goal are free with the part as large as it may be; otherwise a
/// line that says what is not, where, and what to do.
[[nodiscard]] std::string collision(const Task& task, const Start& start, Rollout& rollout);

}  // namespace tenon::planner
