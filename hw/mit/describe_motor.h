#pragma once
// Lines for people about motors in MIT mode. Not real-time (builds strings), pure.

#include <cstdint>
#include <string>

#include "shared/cell/robot.h"
#include "shared/ports/arm.h"

namespace tenon::hw::mit {

/// One line for a fault of an arm of such motors: which motor and joint, what was expected, what to
/// check. Faults of bus and sensor read as those of hw/arm/describe_fault.h.
[[nodiscard]] std::string describe_fault(const ArmFault& fault, const Robot& robot);

/// "over-current", "off"; for a number that has no name "error".
[[nodiscard]] const char* state_text(std::uint32_t state);

/// "0x011", "3.2": as people read it.
[[nodiscard]] std::string register_value(std::uint8_t number, std::uint32_t value);

/// What bring-up does to each motor, register by register. Several lines.
[[nodiscard]] std::string describe_settings(const Robot& robot);

}  // namespace tenon::hw::mit
