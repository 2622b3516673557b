#include "hw/sensors/sensor_start.h"

namespace tenon::hw {

void SensorStart::restart() {
  state_ = State::kAsking;
  fault_ = {};
  at_ = 0;
  tries_ = 0;
}

void SensorStart::advance() {
  tries_ = 0;
  if (++at_ == questions()) state_ = State::kDone;
}

void SensorStart::process(const CanFrame& frame) {
  if (frame.bus != bus_ || state_ != State::kAsking || tries_ == 0) return;
  if (!question(at_).is_answered) return;
  ArmFault fault{ArmFaultKind::kConfiguration, 0, question(at_).object, 0};
  switch (hear(at_, frame, fault)) {
    case Heard::kNothing:
      return;
    case Heard::kAnswer:
      return advance();
    case Heard::kWrong:
      state_ = State::kFailed;
      fault_ = fault;
      return;
  }
}

void SensorStart::update(std::int64_t now_ns, CanBus& bus) {
  if (state_ == State::kAsking && tries_ > 0) {
    const Question asked = question(at_);
    if (now_ns - asked_ns_ < asked.patience_ns) return;
    if (!asked.is_answered) advance();
  }
  if (state_ != State::kAsking) return;
  Question next = question(at_);
  if (tries_ == kTries) {
    state_ = State::kFailed;
    fault_ = {ArmFaultKind::kNoAnswer, 0, next.object, 0};
    return;
  }
  begin(at_);
  // A full queue shows as a sensor that does not answer; of a bus that is gone others tell.
  next.frame.bus = bus_;
  (void)bus.send(next.frame);
  asked_ns_ = now_ns;
  ++tries_;
}

}  // namespace tenon::hw
