#include "executor/identification/identification_motion.h"

namespace tenon::executor {

ControlTask::Turn IdentificationMotion::on_enter(State state) {
  if (state == State::kApproaching) return Event::kAtStart;
  if (state == State::kRunning) begin();
  if (state == State::kStopping || state == State::kHolding) joints().stop();
  return {};
}

ControlTask::Turn IdentificationMotion::ramp_down() {
  return joints().at_rest() ? Turn(Event::kAtRest) : Turn();
}

std::optional<Ending> IdentificationMotion::command_joints() {
  if (state() != State::kRunning) joints().ramp();
  return std::nullopt;
}

Vector6 IdentificationMotion::complete_motion() {
  return kinematics().twist(joints().position(), joints().velocity());
}

// Rigid: the tool's setpoint is the command.
void IdentificationMotion::write_motion(CycleRecord& record) {
  record.setpoint = record.commanded = data_of(kinematics().tool(joints().position()));
}

}  // namespace tenon::executor
