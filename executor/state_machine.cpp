#include "executor/state_machine.h"

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
    case State::kFinished:
      return "finished";
  }
  return "?";
}

State next_state(State state, Event event) {
  switch (state) {
    case State::kWaiting:
      switch (event) {
        case Event::kEnabled:
          return State::kTaring;
        case Event::kStop:
        case Event::kFault:
          return State::kDisabling;
        case Event::kTared:
        case Event::kAtStart:
        case Event::kWorkEnded:
        case Event::kAtRest:
        case Event::kHeld:
        case Event::kDisabled:
          return state;
      }
      break;
    case State::kTaring:
      switch (event) {
        case Event::kTared:
          return State::kApproaching;
        case Event::kStop:
          return State::kHolding;
        case Event::kFault:
          return State::kQuickStopping;
        case Event::kEnabled:
        case Event::kAtStart:
        case Event::kWorkEnded:
        case Event::kAtRest:
        case Event::kHeld:
        case Event::kDisabled:
          return state;
      }
      break;
    case State::kApproaching:
      switch (event) {
        case Event::kAtStart:
          return State::kRunning;
        case Event::kStop:
          return State::kStopping;
        case Event::kFault:
          return State::kQuickStopping;
        case Event::kEnabled:
        case Event::kTared:
        case Event::kWorkEnded:
        case Event::kAtRest:
        case Event::kHeld:
        case Event::kDisabled:
          return state;
      }
      break;
    case State::kRunning:
      switch (event) {
        case Event::kWorkEnded:
          return State::kHolding;
        case Event::kStop:
          return State::kStopping;
        case Event::kFault:
          return State::kQuickStopping;
        case Event::kEnabled:
        case Event::kTared:
        case Event::kAtStart:
        case Event::kAtRest:
        case Event::kHeld:
        case Event::kDisabled:
          return state;
      }
      break;
    case State::kStopping:
      switch (event) {
        case Event::kFault:
          return State::kQuickStopping;
        case Event::kAtRest:
          return State::kHolding;
        case Event::kEnabled:
        case Event::kTared:
        case Event::kAtStart:
        case Event::kWorkEnded:
        case Event::kStop:
        case Event::kHeld:
        case Event::kDisabled:
          return state;
      }
      break;
    case State::kQuickStopping:
      switch (event) {
        case Event::kAtRest:
          return State::kDisabling;
        case Event::kEnabled:
        case Event::kTared:
        case Event::kAtStart:
        case Event::kWorkEnded:
        case Event::kStop:
        case Event::kFault:
        case Event::kHeld:
        case Event::kDisabled:
          return state;
      }
      break;
    case State::kHolding:
      switch (event) {
        case Event::kFault:
          return State::kQuickStopping;
        case Event::kHeld:
          return State::kDisabling;
        case Event::kEnabled:
        case Event::kTared:
        case Event::kAtStart:
        case Event::kWorkEnded:
        case Event::kStop:
        case Event::kAtRest:
        case Event::kDisabled:
          return state;
      }
      break;
    case State::kDisabling:
      switch (event) {
        case Event::kDisabled:
          return State::kFinished;
        case Event::kEnabled:
        case Event::kTared:
        case Event::kAtStart:
        case Event::kWorkEnded:
        case Event::kStop:
        case Event::kFault:
        case Event::kAtRest:
        case Event::kHeld:
          return state;
      }
      break;
    case State::kFinished:
      return State::kFinished;
  }
  // No such state or event: the memory is not what it was. The drives stop by themselves.
  return State::kQuickStopping;
}

}  // namespace tenon::executor
