#include "tests/chain/planned.h"

#include <chrono>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "planner/cell_fit.h"
#include "planner/planner.h"
#include "shared/config/load.h"
#include "sim/rollout/ode_rollout.h"

namespace tenon::tests {
namespace {

std::filesystem::path tree() { return TENON_SOURCE_DIR; }

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

const Task& box_task() {
  static const Task task = load_task(tree() / "planner/tasks/box_on_table_2d.yaml");
  return task;
}

const Cell& gantry_cell() {
  static const Cell cell = load_cell(tree() / "hw/cells/gantry3.yaml");
  return cell;
}

const Start& box_start(const std::string& name) {
  for (const Start& start : box_task().starts) {
    if (start.name == name) return start;
  }
  throw std::runtime_error("no start " + name);
}

Planned plan_box(const Cell& cell, const std::string& start) {
  planner::PlannerOptions options;
  options.threads = 2;
  const planner::CellFit fit = planner::fit_to_cell(box_task(), cell);
  options.assumptions = fit.assumptions;
  const sim::OdeRollout rollout(fit.task);
  const auto report = planner::make_plan(fit.task, box_start(start), rollout, options, now_s);
  if (!report.plan) throw std::runtime_error("start " + start + ": " + report.reason);
  return {fit.task, *report.plan};
}

const Plan& box_plan(const std::string& start) {
  static std::map<std::string, Plan> plans;
  auto found = plans.find(start);
  if (found == plans.end()) found = plans.emplace(start, plan_box(gantry_cell(), start).plan).first;
  return found->second;
}

}  // namespace tenon::tests
