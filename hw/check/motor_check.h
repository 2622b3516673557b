#pragma once
// What bring-up would do to motors in MIT mode, and whether they fit their bus. Without a bus.
// Set-up code, pure.

#include "hw/check/device_check.h"
#include "shared/cell/robot.h"

namespace tenon::hw {

/// Every motor, the bus, and the verdict. @throws InputError where such a robot cannot be driven
[[nodiscard]] CheckReport motor_report(const Robot& robot);

}  // namespace tenon::hw
