#include "tests/support/planned.h"

#include <map>
#include <mutex>

#include "planner/cell_fit/cell_fit.h"
#include "shared/config/load.h"
#include "shared/task/find_start.h"
#include "tests/support/places.h"

namespace tenon::tests {

const Task& box_task() {
  static const Task task = load_task(box_task_file());
  return task;
}

const Cell& gantry_cell() {
  static const Cell cell = load_cell(gantry_cell_file());
  return cell;
}

Cell shipped_cell(const std::string& name) {
  return load_cell(in_tree("hw/cells/" + name + ".yaml"));
}

const Start& box_start(const std::string& name) { return start_or_first(box_task(), name); }

Planned planned_box(const Cell& cell, const std::string& start) {
  return {planner::fit_to_cell(box_task(), cell).task,
          load_plan(shared_plan("box_" + start + "_" + cell.name))};
}

const Plan& box_plan(const std::string& start) {
  static std::mutex mutex;
  static std::map<std::string, Plan> plans;
  const std::lock_guard lock(mutex);
  auto found = plans.find(start);
  if (found == plans.end()) {
    found = plans.emplace(start, planned_box(gantry_cell(), start).plan).first;
  }
  return found->second;
}

}  // namespace tenon::tests
