#pragma once
// Description files of drives that tests write by hand (tests/twins), and virtual drives in their
// likeness.

#include <cstdint>
#include <map>
#include <string>

#include "shared/cell/robot.h"
#include "shared/config/files.h"
#include "shared/eds/device_file.h"
#include "tests/support/places.h"

namespace tenon::tests {

/// tests/twins/NAME.eds
[[nodiscard]] inline DeviceFile twin_file(const std::string& name) {
  const std::string file = "tests/twins/" + name + ".eds";
  return parse_device_file(file, config::read_file(in_tree(file)));
}

/// Every drive of a robot in the likeness of that file; none where the name is empty.
[[nodiscard]] inline std::map<std::uint8_t, DeviceFile> twins_of(const Robot& robot,
                                                                 const std::string& name) {
  std::map<std::uint8_t, DeviceFile> twins;
  if (name.empty()) return twins;
  const DeviceFile file = twin_file(name);
  for (const Joint& joint : robot.joints) twins.emplace(joint.node, file);
  return twins;
}

}  // namespace tenon::tests
