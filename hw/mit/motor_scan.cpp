#include "hw/mit/motor_scan.h"

#include "hw/mit/describe_motor.h"
#include "hw/mit/motor_bring_up.h"
#include "hw/mit/motor_channel.h"
#include "hw/mit/motor_frames.h"
#include "shared/base/text.h"
#include "shared/mit/constants.h"
#include "shared/mit/robot_motors.h"

namespace tenon::hw::mit {
namespace {

namespace wire = tenon::mit;

/// As if the motor had the MST_ID of the file.
std::optional<MotorFeedback> feedback_of(const Joint& joint, const MotorScan::Found& found) {
  if (!found.feedback) return std::nullopt;
  CanFrame frame = *found.feedback;
  frame.id = mit_motor(joint).feedback_id;
  return decode_feedback(joint.node, mit_motor(joint), frame);
}

std::string name_of(const Joint& joint) {
  return format("motor %u (", unsigned{joint.node}) + joint.name + "): ";
}

std::string silence_of(const Robot& robot, const Joint& joint) {
  return describe_fault({ArmFaultKind::kNoAnswer, joint.node, wire::kMasterId, 0}, robot);
}

}  // namespace

MotorScan::MotorScan(const Robot& robot) : joints_(robot.joints), found_(robot.joints.size()) {}

bool MotorScan::asks_feedback() const { return question_ == motor_settings(joints_[at_]).size(); }

void MotorScan::next(bool silent) {
  tries_ = 0;
  if (!silent && !asks_feedback()) {
    ++question_;
    return;
  }
  question_ = 0;
  ++at_;
}

void MotorScan::process(const CanFrame& frame) {
  if (done() || tries_ == 0 || frame.extended || frame.remote || frame.length != 8) return;
  const Joint& joint = joints_[at_];
  Found& found = found_[at_];
  if (asks_feedback()) {
    if (frame.id != found.answers_on || (frame.data[0] & 0x0FU) != joint.node) return;
    found.feedback = frame;
    return next(false);
  }
  // Read as from the identifier that it came on: an MST_ID that nobody has set is the usual slip.
  MitMotor motor = mit_motor(joint);
  motor.feedback_id = found.answers_on.value_or(frame.id);
  const auto answer = decode_register(joint.node, motor, frame);
  const std::uint8_t asked = motor_settings(joint)[question_].number;
  if (!answer || answer->number != asked || answer->command != wire::kReadRegister) return;
  found.answers_on = frame.id;
  found.registers[asked] = answer->value;
  next(false);
}

void MotorScan::update(std::int64_t now_ns, CanBus& bus) {
  if (done() || (tries_ > 0 && now_ns - asked_ns_ < kAnswer_ns)) return;
  if (tries_ == kTries) next(!found_[at_].answers_on);
  if (done()) return;
  const Joint& joint = joints_[at_];
  (void)bus.send(asks_feedback()
                     ? request_feedback_frame(joint.node)
                     : read_register_frame(joint.node, motor_settings(joint)[question_].number));
  asked_ns_ = now_ns;
  ++tries_;
}

std::string describe_registers(const Robot& robot, std::size_t joint,
                               const MotorScan::Found& found) {
  const Joint& its = robot.joints[joint];
  if (!found.answers_on) return silence_of(robot, its);
  std::string text = name_of(its) + format("answers on 0x%03X", *found.answers_on);
  for (const auto& [number, value] : found.registers) {
    if (number == wire::kMasterId || number == wire::kMotorId) continue;
    text += std::string(", ") + register_name(number) + " " + register_value(number, value);
  }
  return text;
}

std::string describe_state(const Robot& robot, std::size_t joint, const MotorScan::Found& found) {
  const Joint& its = robot.joints[joint];
  if (!found.answers_on) return silence_of(robot, its);
  const auto feedback = feedback_of(its, found);
  if (!feedback) {
    return name_of(its) +
           "tells its registers, and no state when asked for it (0xCC); its firmware may be older";
  }
  MotorChannel channel(its, robot.cycle_us);
  CanFrame frame = *found.feedback;
  frame.id = channel.feedback_id();
  (void)channel.take_feedback(frame);
  const std::string what = channel.faulty() ? format("error 0x%X (", unsigned{feedback->state}) +
                                                  state_text(feedback->state) + ")"
                                            : std::string(state_text(feedback->state));
  return name_of(its) + what +
         format(", joint at %.4f rad, %.2f Nm, board %u degC, coil %u degC", channel.position(),
                channel.effort(), unsigned{feedback->board_degC}, unsigned{feedback->coil_degC});
}

std::string refusal_of(const Robot& robot, std::size_t joint, const MotorScan::Found& found) {
  const Joint& its = robot.joints[joint];
  for (const RegisterSetting& setting : motor_settings(its)) {
    const auto told = found.registers.find(setting.number);
    if (told == found.registers.end() || setting.writable || told->second == setting.value) {
      continue;
    }
    return describe_fault({ArmFaultKind::kConfiguration, its.node, setting.number, told->second},
                          robot);
  }
  return {};
}

bool is_well(const Robot& robot, std::size_t joint, const MotorScan::Found& found) {
  const auto feedback = feedback_of(robot.joints[joint], found);
  if (!feedback) return found.answers_on.has_value();
  return feedback->state == wire::kStateOff || feedback->state == wire::kStateOn;
}

}  // namespace tenon::hw::mit
