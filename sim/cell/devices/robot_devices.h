#pragma once
// The devices that a robot file describes, and their data sheets.

#include <string>
#include <vector>

#include "shared/cell/robot.h"
#include "sim/cell/devices/drive_parameters.h"

namespace tenon::sim {

/// Torques of CiA 402 are thousandths of the motor's rated one (6071h, 6077h).
inline constexpr double kPermille = 1000.0;

[[nodiscard]] DriveParameters drive_parameters_of(const Joint& joint);

struct EdsFile {
  std::string name;  ///< "1-drive-x.eds", "4-sensor.eds"
  std::string text;
};

/// One for every node of the robot, as its virtual device answers.
[[nodiscard]] std::vector<EdsFile> eds_files(const Robot& robot);

}  // namespace tenon::sim
