#pragma once
// What is told to people of a sensor that is no CANopen node. Allocates.

#include <cstdint>
#include <optional>
#include <string>

#include "shared/cell/robot.h"
#include "shared/ports/arm.h"

namespace tenon::hw {

/// "force/torque sensor robotous_rft: "
[[nodiscard]] std::string sensor_name(const ForceTorqueSensor& sensor);

/// The line that belongs to a fault of its start, and to one by its own word; unset: it is
/// another's, or told as any sensor's.
[[nodiscard]] std::optional<std::string> describe_sensor(const ArmFault& fault,
                                                         const ForceTorqueSensor& sensor);

/// What bring-up does to it, its identifiers, and what nobody has seen yet; lines for tenon-can
/// check.
[[nodiscard]] std::string describe_start(const ForceTorqueSensor& sensor);

}  // namespace tenon::hw
