#pragma once
// A checked task on one page: what is wrong with it, a picture of each start, and what was
// understood. Pure; any thread.

#include <string>

#include "planner/check/task_check.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// One HTML document that loads nothing and has no script. @param file as the user gave it
[[nodiscard]] std::string check_page(const std::string& file, const Task& task,
                                     const TaskCheck& check);

}  // namespace tenon::planner
