#include "executor/identification/identification_motion.h"

namespace tenon::executor {

void IdentificationMotion::on_enter(State state) {
  switch (state) {
    case State::kApproaching:
      return process_event(Event::kAtStart);
    case State::kRunning:
      return begin();
    case State::kStopping:
    case State::kHolding:
      return joints().stop();
    case State::kWaiting:
    case State::kTaring:
    case State::kQuickStopping:
    case State::kDisabling:
    case State::kFinished:
      return;
  }
}

void IdentificationMotion::ramp_down() {
  if (joints().at_rest()) process_event(Event::kAtRest);
}

Vector6 IdentificationMotion::move() {
  if (state() != State::kRunning) joints().ramp();
  return kinematics().twist(joints().position(), joints().velocity());
}

// Rigid: the tool's setpoint is the command.
void IdentificationMotion::write_motion(CycleRecord& record) {
  record.setpoint = record.commanded = data_of(kinematics().tool(joints().position()));
}

}  // namespace tenon::executor
