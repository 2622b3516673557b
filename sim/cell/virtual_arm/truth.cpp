#include "sim/cell/virtual_arm/truth.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "shared/base/text.h"
#include "sim/cell/virtual_arm/world_json.h"

namespace tenon::sim {
namespace {

using Json = nlohmann::ordered_json;

Json drive_json(const DriveTruth& drive) {
  Json json;
  json["joint"] = drive.joint;
  json["node"] = drive.node;
  json["state"] = drive.state;
  json["brake_engaged"] = drive.brake_engaged;
  json["operational"] = drive.operational;
  json["error_code"] = drive.error_code;
  json["position"] = drive.position;
  return json;
}

// "x +1.2 y -11.6 mm": the translations that are not nothing.
std::string in_mm(const Vector6& displacement) {
  constexpr double kNothing_m = 1e-6;
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(displacement[axis]) < kNothing_m) continue;
    text += format("%s %+.1f ", axis_name(axis), 1e3 * displacement[axis]);
  }
  return text.empty() ? "nothing" : text + "mm";
}

}  // namespace

std::string describe(const Truth& truth) {
  const std::string end = format(
      "%.2f mm from its goal, %s the tolerance of %s; it was pressed with %.0f N at most",
      1e3 * truth.error_norm_m, truth.within_tolerance ? "within" : "NOT within",
      tolerance_text(truth.goal_tolerance_m, truth.goal_axes).c_str(), truth.contact_force_N_max);
  return "the environment was off by " + in_mm(truth.offset) + "\nthe part ended " + end + "\n";
}

std::string truth_json(const Truth& truth) {
  Json json;
  json["task"] = truth.task;
  json["start"] = truth.start;
  json["seed"] = truth.seed;
  json["time_s"] = truth.time_s;
  json["offset"] = by_axis(truth.offset);
  json["world"] = world_json(truth.world);
  json["tool"] = by_axis(displacement_between({}, truth.tool));
  json["error"] = by_axis(truth.error);
  json["error_norm_m"] = truth.error_norm_m;
  json["error_norm_rad"] = truth.error_norm_rad;
  json["goal_tolerance_m"] = truth.goal_tolerance_m;
  json["within_tolerance"] = truth.within_tolerance;
  json["contact_force_N_max"] = truth.contact_force_N_max;
  json["touching"] = truth.touching;
  json["drives"] = Json::array();
  for (const DriveTruth& drive : truth.drives) json["drives"].push_back(drive_json(drive));
  json["faults"] = truth.faults;
  json["solver_messages"] = truth.solver_messages;
  json["frames_not_sent"] = truth.frames_not_sent;
  json["frames_lost"] = truth.frames_lost;
  json["clock"] = {
      {"wakes", truth.wakes}, {"wakes_late", truth.wakes_late}, {"late_max_ms", truth.late_max_ms}};
  json["events"] = Json::array();
  for (const TruthEvent& event : truth.events) {
    json["events"].push_back({{"time_s", event.time_s}, {"what", event.what}});
  }
  return json.dump(2) + "\n";
}

}  // namespace tenon::sim
