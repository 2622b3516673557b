#pragma once
// The line for people that belongs to an ArmFault. Not real-time (builds strings), pure.

#include <string>

#include "shared/cell/robot.h"
#include "shared/ports/arm.h"

namespace tenon::hw {

/// One line: which node and joint, what was expected, what to check. "no fault" for kNone.
/// Example: "node 3 (z): no boot-up within 1.0 s; expected 0x703 after NMT reset; check power,
/// wiring, node id".
[[nodiscard]] std::string describe(const ArmFault& fault, const Robot& robot);

}  // namespace tenon::hw
