#pragma once
// The states of a task of the control cycle (control_task.h) and what leads from one to the next. A
// pure function; any thread.
//
//   kWaiting --enabled--> kTaring --tared--> kApproaching --at start--> kRunning --+
//      |                     |                    | stop                   | stop  | work ended
//      |                     | stop               +-----> kStopping <------+       |
//      |                     |                               | at rest             |
//      |                     +---------> kHolding <----------+---------------------+
//      | stop, fault                        | held
//      +-------------------------------> kDisabling --disabled--> kWatching --held--> kFinished
//                                          ^  ^ at rest               | brake failed
//   a fault while the drives are on --> kQuickStopping                v
//                                          +--------- stop -------- kCatching
//
// What is not drawn changes nothing.

#include <cstdint>

namespace tenon::executor {

/// The numbers stand in telemetry.
enum class State : std::uint8_t {
  kWaiting = 0,        ///< for the drives to be enabled
  kTaring = 1,         ///< holding still, averaging the sensor
  kApproaching = 2,    ///< on the way to the plan's start; an identification has none
  kRunning = 3,        ///< the plan, or the motion of an identification
  kStopping = 4,       ///< the commanded motion ramps down
  kQuickStopping = 5,  ///< the drives ramp down by themselves
  kHolding = 6,        ///< at rest, still compliant
  kDisabling = 7,      ///< drives going off, brakes on
  kFinished = 8,
  kWatching = 9,  ///< off: do the brakes hold?
  kCatching =
      10,  ///< one does not: under power again where the cell wants that, until told to stop
};
[[nodiscard]] const char* to_string(State state);

enum class Event : std::uint8_t {
  kEnabled = 0,  ///< the arm follows setpoints
  kTared = 1,
  kAtStart = 2,
  kWorkEnded = 3,  ///< the plan, or the motion of an identification
  kStop = 4,       ///< ramp down in good order
  kFault = 5,      ///< stop by the drives
  kAtRest = 6,
  kHeld = 7,
  kDisabled = 8,
  kBrakeFailed = 9,
};

[[nodiscard]] State next_state(State state, Event event);

}  // namespace tenon::executor
