#pragma once
// The arm that a robot file names, whatever its drives speak: the one place that tells protocols
// apart for those who compose. Set-up code.

#include <memory>
#include <string>
#include <vector>

#include "hw/arm/device_arm.h"
#include "shared/cell/cell.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

/// @param bus must outlive it  @throws InputError with one line for a robot that cannot be driven
[[nodiscard]] std::unique_ptr<DeviceArm> open_arm(const Cell& cell, CanBus& bus);

/// The line for people that belongs to a fault of such an arm.
[[nodiscard]] std::string fault_text(const ArmFault& fault, const Robot& robot);

/// What matters of this robot's drives and sensor before it is started, and what the cell must
/// provide; one line each.
[[nodiscard]] std::vector<std::string> start_remarks(const Robot& robot);

}  // namespace tenon::hw
