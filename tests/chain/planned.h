#pragma once
// Task, cell and plans that the chain's tests share; made once a process.

#include <string>

#include "shared/cell/cell.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon::tests {

[[nodiscard]] const Task& box_task();
[[nodiscard]] const Cell& gantry_cell();
/// The start of box_task() by name.
[[nodiscard]] const Start& box_start(const std::string& name);
/// Planned for the cell as `tenon-plan --cell` does; through bytes.
[[nodiscard]] const Plan& box_plan(const std::string& start);

}  // namespace tenon::tests
