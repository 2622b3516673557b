#include "sim/cell/devices/robot_devices.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "shared/base/error.h"
#include "shared/canopen/robot_drives.h"
#include "shared/mit/robot_motors.h"
#include "sim/cell/canopen/eds.h"
#include "sim/cell/devices/drive_402.h"
#include "sim/cell/devices/force_torque_node.h"
#include "sim/cell/devices/mit_drive.h"
#include "sim/cell/devices/netcanoem_sensor.h"
#include "sim/cell/devices/no_sensor.h"
#include "sim/cell/devices/rft_sensor.h"

namespace tenon::sim {
namespace {

EdsFile eds_file(const SlaveNode& node, const std::string& name) {
  EdsFile file;
  file.name = std::to_string(node.node()) + "-" + name + ".eds";
  file.text = eds_text(
      node.dictionary(),
      {.file_name = file.name, .product_name = "tenon virtual " + name, .node = node.node()});
  return file;
}

}  // namespace

DriveParameters drive_parameters_of(const Joint& joint) {
  constexpr double kMilli = 1000.0;
  DriveParameters parameters;
  parameters.node = joint.node;
  parameters.name = "tenon virtual drive " + joint.name;
  parameters.mode = static_cast<std::int8_t>(canopen_drive(joint).mode);
  parameters.counts_per_unit = joint.counts_per_unit;
  parameters.quick_stop_counts_ps2 =
      static_cast<std::uint32_t>(std::abs(joint.counts_per_unit) * joint.acceleration_max);
  parameters.rated_effort_mNm = static_cast<std::uint32_t>(kMilli * joint.rated_effort);
  parameters.effort_max_permille = static_cast<std::uint16_t>(
      std::clamp(kPermille * joint.effort_max / joint.rated_effort, 1.0, 65535.0));
  return parameters;
}

VirtualDrives virtual_drives(const Robot& robot, const std::map<std::uint8_t, DeviceFile>& twins) {
  for (const auto& twin : twins) {
    const std::uint8_t node = twin.first;
    const bool of_joint = std::any_of(robot.joints.begin(), robot.joints.end(),
                                      [&](const Joint& joint) { return joint.node == node; });
    if (!of_joint) {
      throw InputError("twin " + twin.second.name + ": node " + std::to_string(node) +
                       " is no joint of robot " + robot.name);
    }
  }
  VirtualDrives drives;
  if (speaks_mit(robot)) {
    if (!twins.empty()) {
      throw InputError("twin " + twins.begin()->second.name + ": the motors of robot " +
                       robot.name + " are no CANopen nodes, no EDS describes them");
    }
    for (const Joint& joint : robot.joints) drives.push_back(std::make_unique<MitDrive>(joint));
    return drives;
  }
  for (const Joint& joint : robot.joints) {
    auto drive = std::make_unique<Drive402>(drive_parameters_of(joint));
    const auto twin = twins.find(joint.node);
    if (twin != twins.end()) drive->become_twin(twin->second);
    drives.push_back(std::move(drive));
  }
  return drives;
}

std::unique_ptr<VirtualSensor> virtual_sensor(const ForceTorqueSensor& sensor, std::uint64_t seed,
                                              const SensorImperfections& imperfections) {
  switch (sensor.protocol) {
    case SensorProtocol::kNode:
      break;
    case SensorProtocol::kNone:
      return std::make_unique<NoSensor>();
    case SensorProtocol::kAtiNetcanoem:
      return std::make_unique<NetcanoemSensor>(sensor, seed, imperfections);
    case SensorProtocol::kRobotousRft:
      return std::make_unique<RftSensor>(sensor, seed, imperfections);
  }
  return std::make_unique<ForceTorqueNode>(sensor, seed, imperfections);
}

std::vector<EdsFile> eds_files(const Robot& robot) {
  std::vector<EdsFile> files;
  for (const Joint& joint : robot.joints) {
    if (speaks_mit(robot)) break;  // no CANopen nodes
    files.push_back(eds_file(Drive402(drive_parameters_of(joint)).node(), "drive-" + joint.name));
  }
  if (robot.sensor.node != 0) {
    files.push_back(eds_file(ForceTorqueNode(robot.sensor, 0).node(), "sensor"));
  }
  return files;
}

}  // namespace tenon::sim
