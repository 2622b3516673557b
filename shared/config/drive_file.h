#pragma once
// The profiles of drives: where a robot's file means them to be, and what they say. Offline.

#include <filesystem>
#include <string>

#include "shared/canopen/drive_profile.h"

namespace tenon {

/// "schunk_lwa4p" is drives/schunk_lwa4p.yaml beside the folder of all robots; what ends in .yaml
/// is a path seen from the robot's file.
[[nodiscard]] inline std::filesystem::path drive_file(const std::filesystem::path& robot_file,
                                                      const std::string& drive) {
  const std::filesystem::path folder = robot_file.parent_path();
  if (drive.ends_with(".yaml")) return (folder / drive).lexically_normal();
  return (folder / ".." / ".." / "drives" / (drive + ".yaml")).lexically_normal();
}

/// hw/drives/NAME.yaml. What the file leaves out is CiA 402 by the book. @throws InputError
[[nodiscard]] DriveProfile load_drive(const std::filesystem::path& file);

}  // namespace tenon
