#pragma once
// Which frames an arm of motors in MIT mode has on its bus in operation, as hw/arm/frame_set.h has
// them for drives. Commands and answers pass in one part of the cycle, for a motor answers as it is
// asked. Set-up code.

#include <vector>

#include "hw/arm/frame_set.h"
#include "shared/cell/robot.h"

namespace tenon::hw::mit {

[[nodiscard]] std::vector<BusFrame> motor_frame_set(const Robot& robot);

}  // namespace tenon::hw::mit
