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

/// A task fitted to a cell, and a plan for it.
struct Planned {
  Task task;
  Plan plan;
};
/// box_task() planned for a cell as `tenon-plan --cell` does; through bytes. Throws without a plan.
[[nodiscard]] Planned plan_box(const Cell& cell, const std::string& start);
/// The same for the gantry, remembered.
[[nodiscard]] const Plan& box_plan(const std::string& start);

}  // namespace tenon::tests
