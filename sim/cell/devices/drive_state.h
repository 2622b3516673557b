#pragma once
// The power state machine of CiA 402 as pure functions: what a command does in a state, what the
// option objects make of it, and which statusword a state shows.
//
//   NotReady ─1─> SwitchOnDisabled <─2,7─> ReadyToSwitchOn <─3,6─> SwitchedOn <─4,5─>
//   OperationEnabled
//                  ^  ^  ^  ^                     ^   │                │                │ │ │   ^
//                  │  │  │  └──── 10 ─────────────│───│────────────────┘                │ │ │   │
//                  │  │  └─────── 9 ──────────────│───│─────────────────────────────────┘ │ │   │
//                  15 │                           └── 8 ──────────────────────────────────┘ │   │
//                  │  └ 12 ─ QuickStopActive <─ 11 ─────────────────────────────────────────┘   │
//                  │              └──────────── 16 ─────────────────────────────────────────────┘
//                 Fault <─14─ FaultReaction <─13─ an error in any state

#include <cstdint>
#include <optional>

namespace tenon::sim {

enum class DriveState : std::uint8_t {
  kNotReady,
  kSwitchOnDisabled,
  kReadyToSwitchOn,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStopActive,
  kFaultReaction,
  kFault,
};

enum class DriveCommand : std::uint8_t {
  kDisableVoltage,
  kQuickStop,
  kShutdown,
  kSwitchOn,
  kEnableOperation,
};

/// What the axis does in a transition.
enum class DriveAction : std::uint8_t {
  kKeep,      ///< what it did
  kPowerOff,  ///< at once, and the brake falls in
  kPowerOn,   ///< holds, and releases the brake
  kResume,    ///< follows targets again, from a standing demand
  kSlowRamp,  ///< stops by 6084h
  kQuickRamp  ///< stops by 6085h
};

/// The option objects, with the values that this drive takes.
struct StopOptions {
  std::int64_t quick_stop = 2;      ///< 605Ah: 0, 1, 2, 5, 6
  std::int64_t shutdown = 0;        ///< 605Bh: 0, 1
  std::int64_t disable = 1;         ///< 605Ch: 0, 1
  std::int64_t fault_reaction = 2;  ///< 605Eh: 0, 1, 2
};

struct DriveTransition {
  DriveState now = DriveState::kNotReady;  ///< entered at once
  DriveAction action = DriveAction::kKeep;
  /// Entered when the action is done: brake open, or axis stopped and brake closed. Unset after a
  /// ramp: the axis stands under power.
  std::optional<DriveState> then;
};

[[nodiscard]] DriveCommand decode_controlword(std::uint16_t word);

/// @param stopped no ramp is running, which transition 16 needs
/// @return unset where the command means nothing in that state
[[nodiscard]] std::optional<DriveTransition> transition(DriveState state, DriveCommand command,
                                                        const StopOptions& options, bool stopped);

/// Transitions 13 and 14. @param can_ramp the axis is under power and stays so
[[nodiscard]] DriveTransition fault_transition(const StopOptions& options, bool can_ramp);

/// The bits of 6041h that tell the state.
[[nodiscard]] std::uint16_t state_word(DriveState state);

[[nodiscard]] const char* to_string(DriveState state);

}  // namespace tenon::sim
