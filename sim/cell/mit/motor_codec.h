#pragma once
// The frames of a motor in MIT mode, the motor's side: written apart from the master's, so that a
// mistake cannot cancel itself. Bits are numbered through the 64 of a frame, the first byte's
// highest first:
//
//   command   0..15 position  16..27 velocity  28..39 stiffness  40..51 damping  52..63 torque
//   feedback  0..3 state  4..7 number  8..23 position  24..35 velocity  36..47 torque
//             48..55 temperature of the board  56..63 of the coil
//
// Pure.

#include <cstdint>

#include "shared/ports/can_bus.h"

namespace tenon::sim {

/// Half of what a field covers, about zero.
struct MotorRanges {
  double position_rad = 12.5;
  double velocity_radps = 30.0;
  double torque_Nm = 10.0;
};

/// A command in SI, in the motor's direction.
struct MotorOrder {
  double position_rad = 0.0;
  double velocity_radps = 0.0;
  double stiffness_Nmprad = 0.0;
  double damping_Nmsprad = 0.0;
  double torque_Nm = 0.0;
};

/// What a motor tells of itself.
struct MotorReport {
  std::uint8_t state = 0;
  std::uint8_t number = 0;
  double position_rad = 0.0;
  double velocity_radps = 0.0;
  double torque_Nm = 0.0;
  std::uint8_t board_degC = 0;
  std::uint8_t coil_degC = 0;
};

/// @param frame of 8 bytes
[[nodiscard]] MotorOrder read_order(const CanFrame& frame, const MotorRanges& ranges);
/// Beyond its range a value is told as the range's end.
[[nodiscard]] CanFrame report_frame(std::uint32_t id, const MotorReport& report,
                                    const MotorRanges& ranges);

}  // namespace tenon::sim
