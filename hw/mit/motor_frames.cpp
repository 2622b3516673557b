#include "hw/mit/motor_frames.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "shared/base/bytes.h"
#include "shared/mit/constants.h"

namespace tenon::hw::mit {
namespace {

namespace wire = tenon::mit;

constexpr std::uint32_t kFull12 = 0xFFF;
constexpr std::uint32_t kFull16 = 0xFFFF;

/// To the nearest step; half a step down, so that zero of a range about zero is 7FFh and 7FFFh.
std::uint32_t steps(double value, double low, double high, std::uint32_t full) {
  const double share = (std::clamp(value, low, high) - low) / (high - low);
  return static_cast<std::uint32_t>(std::ceil(share * full - 0.5));
}

double value_of(std::uint32_t steps, double most, std::uint32_t full) {
  return 2.0 * most * steps / full - most;
}

std::uint8_t byte_of(std::uint32_t value, unsigned shift) {
  return static_cast<std::uint8_t>(value >> shift);
}

bool of_motor(const MitMotor& motor, const CanFrame& frame) {
  return !frame.extended && !frame.remote && frame.length == 8 && frame.id == motor.feedback_id;
}

CanFrame register_frame(std::uint8_t node, std::uint8_t command, std::uint8_t number,
                        std::uint32_t value) {
  CanFrame frame;
  frame.id = wire::kRegisterId;
  frame.length = 8;
  frame.data = {node, 0, command, number};
  store_le(std::span(frame.data).subspan(4), value);
  return frame;
}

}  // namespace

CanFrame command_frame(std::uint8_t node, const MitMotor& motor, const MotorCommand& command) {
  const double p = motor.position_max_rad;
  const double v = motor.velocity_max_radps;
  const double t = motor.torque_max_Nm;
  const std::uint32_t position = steps(command.position_rad, -p, p, kFull16);
  const std::uint32_t velocity = steps(command.velocity_radps, -v, v, kFull12);
  const std::uint32_t stiffness =
      steps(command.stiffness_Nmprad, 0.0, wire::kStiffnessMax, kFull12);
  const std::uint32_t damping = steps(command.damping_Nmsprad, 0.0, wire::kDampingMax, kFull12);
  const std::uint32_t torque = steps(command.torque_Nm, -t, t, kFull12);
  const std::uint32_t first = velocity << 12U | stiffness;
  const std::uint32_t second = damping << 12U | torque;
  CanFrame frame;
  frame.id = node;
  frame.length = 8;
  frame.data = {byte_of(position, 8), byte_of(position, 0), byte_of(first, 16), byte_of(first, 8),
                byte_of(first, 0),    byte_of(second, 16),  byte_of(second, 8), byte_of(second, 0)};
  return frame;
}

CanFrame special_frame(std::uint8_t node, std::uint8_t what) {
  CanFrame frame;
  frame.id = node;
  frame.length = 8;
  frame.data.fill(wire::kFiller);
  frame.data[7] = what;
  return frame;
}

CanFrame read_register_frame(std::uint8_t node, std::uint8_t number) {
  return register_frame(node, wire::kReadRegister, number, 0);
}

CanFrame request_feedback_frame(std::uint8_t node) {
  return register_frame(node, wire::kRequestFeedback, 0, 0);
}

CanFrame write_register_frame(std::uint8_t node, std::uint8_t number, std::uint32_t value) {
  return register_frame(node, wire::kWriteRegister, number, value);
}

std::optional<MotorFeedback> decode_feedback(std::uint8_t node, const MitMotor& motor,
                                             const CanFrame& frame) {
  if (!of_motor(motor, frame) || (frame.data[0] & 0x0FU) != node) return std::nullopt;
  const auto byte = [&](std::size_t i) { return std::uint32_t{frame.data[i]}; };
  return MotorFeedback{byte_of(frame.data[0], 4),
                       value_of(byte(1) << 8U | byte(2), motor.position_max_rad, kFull16),
                       value_of(byte(3) << 4U | byte(4) >> 4U, motor.velocity_max_radps, kFull12),
                       value_of((byte(4) & 0x0FU) << 8U | byte(5), motor.torque_max_Nm, kFull12),
                       frame.data[6],
                       frame.data[7]};
}

std::optional<RegisterAnswer> decode_register(std::uint8_t node, const MitMotor& motor,
                                              const CanFrame& frame) {
  if (!of_motor(motor, frame) || frame.data[0] != node || frame.data[1] != 0) return std::nullopt;
  const std::uint8_t command = frame.data[2];
  if (command != wire::kReadRegister && command != wire::kWriteRegister) return std::nullopt;
  return RegisterAnswer{command, frame.data[3],
                        load_le<std::uint32_t>(std::span(frame.data).subspan(4))};
}

}  // namespace tenon::hw::mit
