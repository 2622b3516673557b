#pragma once
// The line for people that belongs to an ArmFault. Not real-time (builds strings), pure.

#include <string>

#include "hw/arm/setting_runner.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"

namespace tenon::hw {

/// One line: which node and joint, what was expected, what to check. "no fault" for kNone.
/// Example: "node 3 (z): no boot-up within 1.0 s; expected 0x703 after NMT reset; check power,
/// wiring, node id".
[[nodiscard]] std::string describe(const ArmFault& fault, const Robot& robot);

/// "node 2 (y): 6065h:0 holds 0x7D0 (2000) where 0x1388 (5000) was written; taken as it is".
[[nodiscard]] std::string describe(const SettingNote& note, const Robot& robot);

}  // namespace tenon::hw
