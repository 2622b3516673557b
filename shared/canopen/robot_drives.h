#pragma once
// What CANopen alone knows of a robot's joints: it travels with the robot, and none but CANopen's
// own code looks into it.

#include <cstdint>

#include "shared/canopen/drive_profile.h"
#include "shared/cell/robot.h"

namespace tenon {

/// Modes of operation (6060h) that follow a position in every cycle.
enum class DriveMode : std::uint8_t { kInterpolatedPosition = 7, kCyclicSynchronousPosition = 8 };

struct CanopenDrive {
  DriveMode mode = DriveMode::kCyclicSynchronousPosition;
  DriveProfile profile;  ///< what the drive has and lacks
};

/// Of a joint that says nothing of it: CiA 402 by the book, mode 8.
[[nodiscard]] const CanopenDrive& canopen_drive(const Joint& joint);
/// To be changed; makes one where the joint has none. Allocates.
[[nodiscard]] CanopenDrive& canopen_drive(Joint& joint);

}  // namespace tenon
