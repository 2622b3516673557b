#pragma once
// The devices that a robot file describes, and their data sheets.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "shared/cell/robot.h"
#include "shared/eds/device_file.h"
#include "sim/cell/devices/drive_parameters.h"
#include "sim/cell/devices/virtual_drive.h"
#include "sim/cell/devices/virtual_sensor.h"
#include "sim/cell/devices/wrench_sampler.h"

namespace tenon::sim {

/// Torques of CiA 402 are thousandths of the motor's rated one (6071h, 6077h).
inline constexpr double kPermille = 1000.0;

[[nodiscard]] DriveParameters drive_parameters_of(const Joint& joint);

/// One a joint.
using VirtualDrives = std::vector<std::unique_ptr<VirtualDrive>>;

/// The drives that the robot file names. @param twins by node: what that joint's drive answers like
/// @throws InputError for a twin of no joint
[[nodiscard]] VirtualDrives virtual_drives(const Robot& robot,
                                           const std::map<std::uint8_t, DeviceFile>& twins);

/// The force/torque sensor that the robot file names.
[[nodiscard]] std::unique_ptr<VirtualSensor> virtual_sensor(
    const ForceTorqueSensor& sensor, std::uint64_t seed, const SensorImperfections& imperfections);

struct EdsFile {
  std::string name;  ///< "1-drive-x.eds", "4-sensor.eds"
  std::string text;
};

/// One for every CANopen node of the robot, as its virtual device answers.
[[nodiscard]] std::vector<EdsFile> eds_files(const Robot& robot);

}  // namespace tenon::sim
