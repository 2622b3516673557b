#pragma once
// What of a cycle's message means something, by the state that it was published in. Pure.

#include "executor/states/state_machine.h"

namespace tenon::executor {

[[nodiscard]] constexpr bool knows_joints(State state) { return state != State::kWaiting; }

/// Before the tare nobody knows what the sensor reads of itself.
[[nodiscard]] constexpr bool knows_forces(State state) {
  return state != State::kWaiting && state != State::kTaring;
}

/// Whether the executor moves the tool by setpoints.
[[nodiscard]] constexpr bool commands(State state) {
  return state == State::kApproaching || state == State::kRunning || state == State::kStopping ||
         state == State::kHolding;
}

}  // namespace tenon::executor
