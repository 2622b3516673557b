#include "executor/dry_run/dry_run_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "executor/dry_run/start_positions.h"
#include "shared/base/text.h"
#include "shared/joint_torque/torque_map.h"

namespace tenon::executor {
namespace {

using Json = nlohmann::ordered_json;

const Joint& joint_of(const Cell& cell, const JointExtreme& extreme) {
  return cell.robot.joints[static_cast<std::size_t>(extreme.joint)];
}

std::string line(const StepDemand& step, const Cell& cell) {
  const Joint& near = joint_of(cell, step.limit);
  const Joint& fast = joint_of(cell, step.speed);
  const Joint& hasty = joint_of(cell, step.acceleration);
  return format(
      "%4d  %-10s %8.4f %-3s %8.4f %-3s   %-10s %5.1f %%   %-10s %5.1f %%   %6.3f   %5.3f\n",
      static_cast<int>(step.step), near.name.c_str(), step.limit_position, joint_unit(near),
      step.limit.value, joint_unit(near), fast.name.c_str(), 100.0 * step.speed.value,
      hasty.name.c_str(), 100.0 * step.acceleration.value, step.conditioning, step.slow_down);
}

/// N and Nm; null where the arm tells nothing.
Json resolution_json(const Vector6& resolution) {
  Json json = Json::array();
  for (const double value : resolution) {
    json.push_back(std::isfinite(value) ? Json(value) : Json());
  }
  return json;
}

Json json_of(const StepDemand& step, const Cell& cell) {
  Json json = {{"step", step.step},
               {"points", step.points},
               {"limit_joint", joint_of(cell, step.limit).name},
               {"limit_position", step.limit_position},
               {"limit_margin", step.limit.value},
               {"speed_joint", joint_of(cell, step.speed).name},
               {"speed_share", step.speed.value},
               {"acceleration_joint", joint_of(cell, step.acceleration).name},
               {"acceleration_share", step.acceleration.value},
               {"conditioning", step.conditioning},
               {"slow_down", step.slow_down}};
  if (cell.joint_torque) json["resolution"] = resolution_json(step.resolution);
  return json;
}

}  // namespace

std::string to_table(const DryRun& run, const Cell& cell) {
  std::string text = "start:";
  for (std::size_t i = 0; run.start && i < cell.robot.joints.size(); ++i) {
    const Joint& joint = cell.robot.joints[i];
    text += format(" %s %.4f %s", joint.name.c_str(), (*run.start)[i], joint_unit(joint));
  }
  text += run.start ? "\n" : " out of reach\n";
  text +=
      "step  nearest limit            margin       fastest joint        most accelerated     "
      "condit.  slow-down\n";
  for (const StepDemand& step : run.steps) text += line(step, cell);
  text += resolved_steps(run, cell);
  for (const std::string& refusal : run.refusals) text += "refused: " + refusal + "\n";
  return text;
}

std::string to_json(const DryRun& run, const Plan& plan, const Cell& cell) {
  Json json = {{"status", run.refusals.empty() ? "accepted" : "refused"},
               {"refusals", run.refusals},
               {"task", plan.task_name},
               {"start", plan.start_name},
               {"cell", cell.name},
               {"robot", cell.robot.name}};
  json["start_joints"] = Json::array();
  for (std::size_t i = 0; run.start && i < cell.robot.joints.size(); ++i) {
    json["start_joints"].push_back(
        {{"joint", cell.robot.joints[i].name}, {"position", (*run.start)[i]}});
  }
  json["steps"] = Json::array();
  for (const StepDemand& step : run.steps) json["steps"].push_back(json_of(step, cell));
  return json.dump(2) + "\n";
}

std::string resolved_steps(const DryRun& run, const Cell& cell) {
  std::string text;
  if (!cell.joint_torque) return text;
  for (const StepDemand& step : run.steps) {
    text += format("step %d: the joints' efforts resolve ", static_cast<int>(step.step)) +
            resolution_text(step.resolution) + "\n";
  }
  return text;
}

std::string slowed_steps(const DryRun& run, const Cell& cell) {
  std::string text;
  for (const StepDemand& step : run.steps) {
    if (step.slow_down < 1.0) {
      text += format("step %d runs at %.3f of its speed: ", static_cast<int>(step.step),
                     step.slow_down) +
              asked_for(step, cell) + "\n";
    }
  }
  return text;
}

}  // namespace tenon::executor
