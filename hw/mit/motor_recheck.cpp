#include "hw/mit/motor_recheck.h"

#include "hw/mit/motor_frames.h"
#include "shared/mit/constants.h"
#include "shared/mit/robot_motors.h"

namespace tenon::hw::mit {

MotorRecheck::MotorRecheck(const Robot& robot) {
  for (const Joint& joint : robot.joints) {
    for (const RegisterSetting& setting : motor_settings(joint)) {
      // What a reset takes away: bring-up has written it to the motor's working memory alone.
      if (!setting.writable || count_ == questions_.size()) continue;
      questions_[count_++] = {joint.node, setting.number, setting.value, mit_motor(joint)};
    }
  }
}

void MotorRecheck::restart() noexcept {
  at_ = 0;
  tries_ = waited_ = 0;
  fault_.reset();
}

std::optional<CanFrame> MotorRecheck::next() noexcept {
  if (done() || fault_) return std::nullopt;
  if (tries_ > 0 && ++waited_ < kAnswerCycles) return std::nullopt;
  const Question& question = questions_[at_];
  if (tries_ == kTries) {
    fault_ = ArmFault{ArmFaultKind::kNoAnswer, question.node, question.number};
    return std::nullopt;
  }
  ++tries_;
  waited_ = 0;
  return read_register_frame(question.node, question.number);
}

// The feedback of a motor that is on begins with its state: no answer of a register looks like it.
bool MotorRecheck::take(const CanFrame& frame) noexcept {
  if (done() || fault_ || tries_ == 0) return false;
  const Question& question = questions_[at_];
  const auto answer = decode_register(question.node, question.motor, frame);
  if (!answer || answer->command != tenon::mit::kReadRegister ||
      answer->number != question.number) {
    return false;
  }
  if (answer->value != question.value) {
    fault_ = ArmFault{ArmFaultKind::kConfiguration, question.node, question.number, answer->value};
    return true;
  }
  ++at_;
  tries_ = waited_ = 0;
  return true;
}

}  // namespace tenon::hw::mit
