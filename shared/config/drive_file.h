#pragma once
// Where a robot's file means its drives' profiles to be. Offline.

#include <filesystem>
#include <string>

namespace tenon {

/// "schunk_lwa4p" is drives/schunk_lwa4p.yaml beside the folder of all robots; what ends in .yaml
/// is a path seen from the robot's file.
[[nodiscard]] inline std::filesystem::path drive_file(const std::filesystem::path& robot_file,
                                                      const std::string& drive) {
  const std::filesystem::path folder = robot_file.parent_path();
  if (drive.ends_with(".yaml")) return (folder / drive).lexically_normal();
  return (folder / ".." / ".." / "drives" / (drive + ".yaml")).lexically_normal();
}

}  // namespace tenon
