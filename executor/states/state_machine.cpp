#include "executor/states/state_machine.h"

namespace tenon::executor {

const char* to_string(State state) {
  switch (state) {
    case State::kWaiting:
      return "waiting";
    case State::kTaring:
      return "taring";
    case State::kApproaching:
      return "approaching";
    case State::kRunning:
      return "running";
    case State::kStopping:
      return "stopping";
    case State::kQuickStopping:
      return "quick stopping";
    case State::kHolding:
      return "holding";
    case State::kDisabling:
      return "disabling";
    case State::kWatching:
      return "watching the brakes";
    case State::kCatching:
      return "catching what a brake does not hold";
    case State::kFinished:
      return "finished";
  }
  return "?";
}

State next_state(State state, Event event) {
  if (state == State::kFinished) return state;
  // No such event, or below no such state: the memory is not what it was. The drives stop by
  // themselves.
  if (event > Event::kBrakeFailed) return State::kQuickStopping;
  const auto on = [event](Event awaited) { return event == awaited; };
  switch (state) {
    case State::kWaiting:
      if (on(Event::kEnabled)) return State::kTaring;
      return on(Event::kStop) || on(Event::kFault) ? State::kDisabling : state;
    case State::kTaring:
      if (on(Event::kTared)) return State::kApproaching;
      if (on(Event::kStop)) return State::kHolding;
      return on(Event::kFault) ? State::kQuickStopping : state;
    case State::kApproaching:
      if (on(Event::kAtStart)) return State::kRunning;
      if (on(Event::kStop)) return State::kStopping;
      return on(Event::kFault) ? State::kQuickStopping : state;
    case State::kRunning:
      if (on(Event::kWorkEnded)) return State::kHolding;
      if (on(Event::kStop)) return State::kStopping;
      return on(Event::kFault) ? State::kQuickStopping : state;
    case State::kStopping:
      if (on(Event::kAtRest)) return State::kHolding;
      return on(Event::kFault) ? State::kQuickStopping : state;
    case State::kQuickStopping:
      return on(Event::kAtRest) ? State::kDisabling : state;
    case State::kHolding:
      if (on(Event::kHeld)) return State::kDisabling;
      return on(Event::kFault) ? State::kQuickStopping : state;
    case State::kDisabling:
      return on(Event::kDisabled) ? State::kWatching : state;
    case State::kWatching:
      if (on(Event::kBrakeFailed)) return State::kCatching;
      return on(Event::kHeld) ? State::kFinished : state;
    case State::kCatching:
      return on(Event::kStop) ? State::kDisabling : state;
    case State::kFinished:
      return state;
  }
  return State::kQuickStopping;
}

}  // namespace tenon::executor
