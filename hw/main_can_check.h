#pragma once
// The part of tenon-can that needs no bus.

#include <string>
#include <vector>

namespace tenon::hw {

/// Prints what bring-up would do. @param eds FILE for every joint, NODE=FILE for one; a DCF that
/// names one of the robot's nodes is for that one. @return 0: it would come up, 1: it would not
[[nodiscard]] int check_robot_file(const std::string& robot, const std::vector<std::string>& eds);

}  // namespace tenon::hw
