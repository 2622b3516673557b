#pragma once
// The frames of a motor in MIT mode, the master's side. Standard identifiers, 8 bytes each:
//
//   command, to the motor's number, big-endian, each field linear over its range:
//   | 0-1 position, 16 bit | 2 and high half of 3 velocity, 12 bit | low half of 3 and 4 stiffness
//   | | 5 and high half of 6 damping, 12 bit | low half of 6 and 7 torque, 12 bit | special frame,
//   to the motor's number: | 0-6 FFh | 7 FCh enable, FDh disable, FBh clear error | feedback, from
//   its MST_ID: | 0 high half state or error, low half number | 1-2 position, 16 bit | | 3 and high
//   half of 4 velocity, 12 bit | low half of 4 and 5 torque, 12 bit | | 6 temperature of the board,
//   degC | 7 of the coil | register, to 7FFh and back from its MST_ID: | 0-1 number, little-endian
//   | 2 33h read, 55h write | 3 register | 4-7 value, little-endian |
//
// Pure, real-time: no allocation, no throw.

#include <cstdint>
#include <optional>

#include "shared/mit/robot_motors.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw::mit {

/// In the motor's own direction, from its own zero. What is beyond a range is sent as its end.
struct MotorCommand {
  double position_rad = 0.0;
  double velocity_radps = 0.0;
  double stiffness_Nmprad = 0.0;
  double damping_Nmsprad = 0.0;
  double torque_Nm = 0.0;
};

struct MotorFeedback {
  std::uint8_t state = 0;  ///< tenon::mit::kStateOff, kStateOn or an error
  double position_rad = 0.0;
  double velocity_radps = 0.0;
  double torque_Nm = 0.0;
  std::uint8_t board_degC = 0;
  std::uint8_t coil_degC = 0;
};

struct RegisterAnswer {
  std::uint8_t command = 0;  ///< which it answers
  std::uint8_t number = 0;   ///< of the register
  std::uint32_t value = 0;   ///< its four bytes; of a float, its bits
};

[[nodiscard]] CanFrame command_frame(std::uint8_t node, const MitMotor& motor,
                                     const MotorCommand& command);
/// @param what tenon::mit::kEnable, kDisable, kClearError
[[nodiscard]] CanFrame special_frame(std::uint8_t node, std::uint8_t what);
[[nodiscard]] CanFrame read_register_frame(std::uint8_t node, std::uint8_t number);
/// Asks for a feedback, and for nothing else.
[[nodiscard]] CanFrame request_feedback_frame(std::uint8_t node);
[[nodiscard]] CanFrame write_register_frame(std::uint8_t node, std::uint8_t number,
                                            std::uint32_t value);

/// Empty: not 8 bytes, or of another motor.
[[nodiscard]] std::optional<MotorFeedback> decode_feedback(std::uint8_t node, const MitMotor& motor,
                                                           const CanFrame& frame);
/// Empty: none of this motor's.
[[nodiscard]] std::optional<RegisterAnswer> decode_register(std::uint8_t node,
                                                            const MitMotor& motor,
                                                            const CanFrame& frame);

}  // namespace tenon::hw::mit
