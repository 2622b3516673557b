#pragma once
// A task as one cell can execute it. Compliance, contact speed and thresholds of a task file are
// wishes for an arm that is fast enough; a slow arm at a stiff contact needs more damping, slower
// touches, and a debounce that spans some of its samples. The plan carries what comes out of here,
// so that the simulation sees it from the start.

#include <string>
#include <vector>

#include "planner/cell_fit/cell_assumptions.h"
#include "shared/cell/cell.h"
#include "shared/task/task.h"

namespace tenon::planner {

struct CellFit {
  Task task;
  CellAssumptions assumptions;
  std::vector<std::string> changes;  ///< one line each: what became what, and why
};

/// Changes what must be changed and nothing else, so that the executor's check of the plan against
/// this cell passes: D up to 1.5 k_e tau and a tenth more, M down to D tau, the contact speed down
/// until the peak force is within four fifths of the cell's force fault, and with the held part's
/// farthest point as its lever within four fifths of the torque fault; all force thresholds up
/// together to five deviations of the sensor's noise and to what joints' efforts resolve, the
/// debounce up to two of the sensor's periods. The time limit of a move grows as its contact speed
/// falls.
/// @throws InputError with both numbers where the contact speed would fall below 2 mm/s, or a
/// force limit does not fit the cell
[[nodiscard]] CellFit fit_to_cell(const Task& task, const Cell& cell);

}  // namespace tenon::planner
