#include "sim/cell/virtual_arm/world_json.h"

#include <nlohmann/json.hpp>
#include <vector>

#include "shared/base/text.h"

namespace tenon::sim {
namespace {

using Json = nlohmann::ordered_json;

Json list(const Vector3& value) { return {value.x(), value.y(), value.z()}; }

Json list(const std::vector<Vector3>& values) {
  Json json = Json::array();
  for (const Vector3& value : values) json.push_back(list(value));
  return json;
}

Json friction_json(const std::vector<DriveFriction>& drives) {
  Json json = Json::array();
  for (const DriveFriction& drive : drives) {
    json.push_back({{"coulomb_share", drive.coulomb_share},
                    {"viscous_share", drive.viscous_share},
                    {"hysteresis_share", drive.hysteresis_share},
                    {"way_factor", drive.way_factor},
                    {"start", drive.start}});
  }
  return json;
}

}  // namespace

Json by_axis(const Vector6& value) {
  Json json;
  for (int axis = 0; axis < 6; ++axis) json[axis_key(axis)] = value[axis];
  return json;
}

Json world_json(const WorldDraw& world) {
  Json json;
  const auto where_drawn = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json();
  };
  json["friction"] = where_drawn(world.friction);
  json["contact_stiffness_Npm"] = where_drawn(world.contact_stiffness_Npm);
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
  json["drive_friction"] = friction_json(world.drive_friction);
  json["sensor_noise_factor"] = world.sensor_noise_factor;
  json["force_drift_N_sqrts"] = world.force_drift_N_sqrts;
  json["torque_drift_Nm_sqrts"] = world.torque_drift_Nm_sqrts;
  return json;
}

}  // namespace tenon::sim
