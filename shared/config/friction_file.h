#pragma once
// What `tenon-exec --identify-friction` writes of a robot's drives and a cell's joint_torque names.
// Offline.

#include <filesystem>
#include <string>
#include <vector>

#include "shared/cell/cell.h"

namespace tenon::config {

/// One a joint of the robot, in its order. @throws InputError also where they are another robot's
[[nodiscard]] std::vector<JointFriction> read_friction(const std::filesystem::path& file,
                                                       const Robot& robot);

}  // namespace tenon::config
