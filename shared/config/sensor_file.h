#pragma once
// The profiles of force/torque sensors: where a robot's file means them to be, and a robot's sensor
// as profile and file together say. Offline.

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

#include "shared/cell/robot.h"
#include "shared/config/yaml_value.h"

namespace tenon::config {

/// "robotous_rft" is sensors/robotous_rft.yaml beside the folder of all robots; what ends in .yaml
/// is a path seen from the robot's file.
[[nodiscard]] inline std::filesystem::path sensor_file(const std::filesystem::path& robot_file,
                                                       const std::string& profile) {
  const std::filesystem::path folder = robot_file.parent_path();
  if (profile.ends_with(".yaml")) return (folder / profile).lexically_normal();
  return (folder / ".." / ".." / "sensors" / (profile + ".yaml")).lexically_normal();
}

/// hw/sensors/NAME.yaml, whose keys are known; what they say read_sensor() judges.
/// @throws InputError
[[nodiscard]] Value read_sensor_profile(const std::filesystem::path& file);

/// A robot's `sensor`, but for its period. What it leaves out its profile says; without a profile
/// it is a CANopen node. @param nodes that are taken; its own is added  @throws InputError
[[nodiscard]] ForceTorqueSensor read_sensor(const Value& value,
                                            const std::filesystem::path& robot_file,
                                            std::set<std::int64_t>& nodes);

/// In cycles of `cycle_us`: what is asked by the cycle has a whole number of them, what has a clock
/// of its own its period rounded up. @throws InputError
void read_sample_period(const Value& value, std::uint32_t cycle_us, ForceTorqueSensor& sensor);

}  // namespace tenon::config
