#pragma once
// Whose identifiers are whose on a robot's bus, so that none is two devices'. Set-up code.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "shared/cell/robot.h"

namespace tenon::hw {

struct IdentifierOwner {
  std::uint32_t id = 0;  ///< 11 bits
  std::string owner;     ///< for people: "feedback of arm_1"
};

/// Of a sensor that is no CANopen node.
[[nodiscard]] std::vector<IdentifierOwner> sensor_identifiers(const ForceTorqueSensor& sensor);

/// What CANopen and the drives of an arm use.
[[nodiscard]] std::vector<IdentifierOwner> canopen_identifiers(const Robot& robot);

/// Throws InputError where a sensor that is no CANopen node, on the arm's bus, has an identifier of
/// `others`; names both.
void check_sensor_identifiers(const Robot& robot, std::span<const IdentifierOwner> others);

}  // namespace tenon::hw
