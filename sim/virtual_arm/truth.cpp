#include "sim/virtual_arm/truth.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace tenon::sim {
namespace {

using Json = nlohmann::ordered_json;

Json by_axis(const Vector6& value) {
  static constexpr std::array<const char*, 6> kNames = {"x_m",    "y_m",    "z_m",
                                                        "rx_rad", "ry_rad", "rz_rad"};
  Json json;
  for (int axis = 0; axis < 6; ++axis) json[kNames[static_cast<std::size_t>(axis)]] = value[axis];
  return json;
}

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

Json list(const Vector3& value) { return {value.x(), value.y(), value.z()}; }

Json list(const std::vector<Vector3>& values) {
  Json json = Json::array();
  for (const Vector3& value : values) json.push_back(list(value));
  return json;
}

Json world_json(const WorldDraw& world) {
  Json json;
  json["friction"] = world.friction.value_or(0.0);
  json["contact_stiffness_Npm"] = world.contact_stiffness_Npm.value_or(0.0);
  json["clearance_m"] = world.clearance_m;
  json["held_size_error_m"] = list(world.held_size_error_m);
  json["environment_size_error_m"] = list(world.environment_size_error_m);
  json["task_in_base_error"] = by_axis(world.task_in_base_error);
  json["tool_in_flange_error"] = by_axis(world.tool_in_flange_error);
  json["sensor_in_flange_error"] = by_axis(world.sensor_in_flange_error);
  json["payload_mass_error_kg"] = world.payload_mass_error_kg;
  json["payload_com_error_m"] = list(world.payload_com_error_m);
  json["servo_stiffness_factor"] = world.servo_stiffness_factor;
  json["extra_delay_s"] = world.extra_delay_s;
  json["backlash_m"] = world.backlash_m;
  json["backlash_rad"] = world.backlash_rad;
  json["sensor_noise_factor"] = world.sensor_noise_factor;
  json["force_drift_N_sqrts"] = world.force_drift_N_sqrts;
  json["torque_drift_Nm_sqrts"] = world.torque_drift_Nm_sqrts;
  return json;
}

// "x +1.2 y -11.6 mm": the translations that are not nothing.
std::string in_mm(const Vector6& displacement) {
  constexpr double kNothing_m = 1e-6;
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(displacement[axis]) < kNothing_m) continue;
    std::array<char, 32> part{};
    std::snprintf(part.data(), part.size(), "%c %+.1f ", 'x' + axis, 1e3 * displacement[axis]);
    text += part.data();
  }
  return text.empty() ? "nothing" : text + "mm";
}

}  // namespace

std::string describe(const Truth& truth) {
  std::array<char, 200> rest{};
  std::snprintf(
      rest.data(), rest.size(),
      "%.2f mm from its goal, %s the tolerance of %g mm; it was pressed with %.0f N at most",
      1e3 * truth.error_norm_m, truth.within_tolerance ? "within" : "NOT within",
      1e3 * truth.goal_tolerance_m, truth.contact_force_N_max);
  return "the environment was off by " + in_mm(truth.offset) + "\nthe part ended " + rest.data() +
         "\n";
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
  json["clock"] = {
      {"wakes", truth.wakes}, {"wakes_late", truth.wakes_late}, {"late_max_ms", truth.late_max_ms}};
  json["events"] = Json::array();
  for (const TruthEvent& event : truth.events) {
    json["events"].push_back({{"time_s", event.time_s}, {"what", event.what}});
  }
  return json.dump(2) + "\n";
}

}  // namespace tenon::sim
