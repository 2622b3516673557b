#include "hw/mit/motor_bring_up.h"

#include <bit>

#include "hw/mit/motor_frames.h"
#include "shared/mit/constants.h"
#include "shared/mit/robot_motors.h"

namespace tenon::hw::mit {
namespace {

namespace wire = tenon::mit;

std::uint32_t bits_of(double value) {
  return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

}  // namespace

std::vector<RegisterSetting> motor_settings(const Joint& joint) {
  const MitMotor& motor = mit_motor(joint);
  constexpr std::uint32_t kMicrosecondsPerMillisecond = 1000;
  const std::uint32_t timeout =
      motor.watchdog_ms * kMicrosecondsPerMillisecond / wire::kTimeoutUnit_us;
  return {{wire::kMasterId, motor.feedback_id, false},
          {wire::kMotorId, joint.node, false},
          {wire::kPositionMax, bits_of(motor.position_max_rad), false},
          {wire::kVelocityMax, bits_of(motor.velocity_max_radps), false},
          {wire::kTorqueMax, bits_of(motor.torque_max_Nm), false},
          {wire::kControlMode, wire::kModeMit, true},
          {wire::kTimeout, timeout, true}};
}

const char* register_name(std::uint8_t number) {
  switch (number) {
    case wire::kMasterId:
      return "MST_ID";
    case wire::kMotorId:
      return "ESC_ID";
    case wire::kTimeout:
      return "TIMEOUT";
    case wire::kControlMode:
      return "CTRL_MODE";
    case wire::kPositionMax:
      return "PMAX";
    case wire::kVelocityMax:
      return "VMAX";
    case wire::kTorqueMax:
      return "TMAX";
  }
  return "register";
}

bool is_float(std::uint8_t number) {
  return number == wire::kPositionMax || number == wire::kVelocityMax || number == wire::kTorqueMax;
}

MotorBringUp::MotorBringUp(const Robot& robot) : joints_(robot.joints) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    for (const RegisterSetting& setting : motor_settings(joints_[i]))
      tasks_.push_back({i, setting});
  }
}

void MotorBringUp::restart() {
  at_ = 0;
  tries_ = 0;
  written_ = false;
  state_ = State::kAsking;
  fault_ = {};
}

void MotorBringUp::fail(ArmFaultKind kind, std::uint32_t code) {
  const Task& task = tasks_[at_];
  state_ = State::kFailed;
  fault_ = {kind, joints_[task.joint].node, task.setting.number, code};
}

void MotorBringUp::ask(std::int64_t now_ns, CanBus& bus) {
  const Task& task = tasks_[at_];
  const std::uint8_t node = joints_[task.joint].node;
  // Whatever it did before, it stands without power from here on.
  if (tries_ == 0 && task.setting.number == wire::kMasterId) {
    (void)bus.send(special_frame(node, wire::kDisable));
  }
  (void)bus.send(read_register_frame(node, task.setting.number));
  asked_ns_ = now_ns;
  ++tries_;
}

void MotorBringUp::advance(std::int64_t now_ns, CanBus& bus) {
  tries_ = 0;
  written_ = false;
  if (++at_ == tasks_.size()) {
    state_ = State::kDone;
    return;
  }
  ask(now_ns, bus);
}

void MotorBringUp::process(const CanFrame& frame, std::int64_t now_ns, CanBus& bus) {
  if (state_ != State::kAsking || tries_ == 0) return;
  const Task& task = tasks_[at_];
  const Joint& joint = joints_[task.joint];
  const auto answer = decode_register(joint.node, mit_motor(joint), frame);
  if (!answer || answer->number != task.setting.number) return;
  if (answer->command == wire::kWriteRegister) return ask(now_ns, bus);
  if (answer->value == task.setting.value) return advance(now_ns, bus);
  if (!task.setting.writable || written_) {
    return fail(ArmFaultKind::kConfiguration, answer->value);
  }
  written_ = true;
  tries_ = 0;
  (void)bus.send(write_register_frame(joint.node, task.setting.number, task.setting.value));
  asked_ns_ = now_ns;
}

void MotorBringUp::update(std::int64_t now_ns, CanBus& bus) {
  if (state_ != State::kAsking) return;
  const bool first = tries_ == 0 && !written_;
  if (!first && now_ns - asked_ns_ < kAnswer_ns) return;
  if (tries_ >= kTries) return fail(ArmFaultKind::kNoAnswer, 0);
  ask(now_ns, bus);
}

}  // namespace tenon::hw::mit
