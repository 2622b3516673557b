#pragma once
// What a real arm is beyond the arm port, whatever its devices speak. As real-time as the port.

#include <string>
#include <vector>

#include "hw/arm/arm_counters.h"
#include "shared/ports/arm.h"

namespace tenon::hw {

class DeviceArm : public Arm {
 public:
  [[nodiscard]] virtual const ArmCounters& counters() const noexcept = 0;
  /// What prepare() found that a user must know, one line each; empty before. Not real-time.
  [[nodiscard]] virtual std::vector<std::string> notes() const = 0;
};

}  // namespace tenon::hw
