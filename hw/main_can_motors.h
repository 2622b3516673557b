#pragma once
// `tenon-can scan --robot` and `state --robot`: motors in MIT mode, which answer only who knows
// their numbers.

#include <string>

#include "shared/cell/robot.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

/// @throws InputError where the file cannot be read, or its drives are CANopen nodes
[[nodiscard]] Robot load_motors(const std::string& robot_file);

/// Prints a line a motor. @param state how they do, else who they are  @return the exit status
[[nodiscard]] int look_at_motors(CanBus& bus, const Robot& robot, bool state);

}  // namespace tenon::hw
