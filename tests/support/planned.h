#pragma once
// Task, cell and plans that tests share. The plans are made with the build (tests/plans), so that
// no test plans what another has planned.

#include <string>

#include "shared/cell/cell.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon::tests {

[[nodiscard]] const Task& box_task();
[[nodiscard]] const Cell& gantry_cell();
/// A cell of the tree: "csp6".
[[nodiscard]] Cell shipped_cell(const std::string& name);
/// The start of box_task() by name.
[[nodiscard]] const Start& box_start(const std::string& name);

/// A task fitted to a cell, and a plan for it.
struct Planned {
  Task task;
  Plan plan;
};
/// box_task() and its shared plan for a cell, which is named as that plan is: box_START_NAME.tnp.
[[nodiscard]] Planned planned_box(const Cell& cell, const std::string& start);
/// The shared plan for the gantry, remembered. Any thread may ask.
[[nodiscard]] const Plan& box_plan(const std::string& start);

}  // namespace tenon::tests
