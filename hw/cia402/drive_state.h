#pragma once
// The state of a drive as its statusword tells it (CiA 402-2, table "statusword coding"). Pure.
//
//   | state                 | statusword          | mask | value |
//   | not ready to switch on| xxxx xxxx x0xx 0000 | 4Fh  | 00h   |
//   | switch on disabled    | xxxx xxxx x1xx 0000 | 4Fh  | 40h   |
//   | ready to switch on    | xxxx xxxx x01x 0001 | 6Fh  | 21h   |
//   | switched on           | xxxx xxxx x01x 0011 | 6Fh  | 23h   |
//   | operation enabled     | xxxx xxxx x01x 0111 | 6Fh  | 27h   |
//   | quick stop active     | xxxx xxxx x00x 0111 | 6Fh  | 07h   |
//   | fault reaction active | xxxx xxxx x0xx 1111 | 4Fh  | 0Fh   |
//   | fault                 | xxxx xxxx x0xx 1000 | 4Fh  | 08h   |

#include <cstdint>

#include "shared/canopen/constants.h"

namespace tenon::hw::cia402 {

/// Statusword bit 12 in modes 7 and 8: the drive takes up targets.
inline constexpr std::uint16_t kStatusFollowsTargets = 0x1000;

enum class DriveState : std::uint8_t {
  kUnknown = 0,  ///< no word of the table: treated as not ready
  kNotReadyToSwitchOn = 1,
  kSwitchOnDisabled = 2,
  kReadyToSwitchOn = 3,
  kSwitchedOn = 4,
  kOperationEnabled = 5,
  kQuickStopActive = 6,
  kFaultReactionActive = 7,
  kFault = 8,
};

[[nodiscard]] constexpr DriveState decode_statusword(std::uint16_t statusword) {
  const auto short_bits = statusword & tenon::canopen::kStatusMaskShort;
  const auto long_bits = statusword & tenon::canopen::kStatusMaskLong;
  if (short_bits == tenon::canopen::kStatusNotReady) return DriveState::kNotReadyToSwitchOn;
  if (short_bits == tenon::canopen::kStatusSwitchOnDisabled) return DriveState::kSwitchOnDisabled;
  if (short_bits == tenon::canopen::kStatusFaultReaction) return DriveState::kFaultReactionActive;
  if (short_bits == tenon::canopen::kStatusFault) return DriveState::kFault;
  if (long_bits == tenon::canopen::kStatusReadyToSwitchOn) return DriveState::kReadyToSwitchOn;
  if (long_bits == tenon::canopen::kStatusSwitchedOn) return DriveState::kSwitchedOn;
  if (long_bits == tenon::canopen::kStatusOperationEnabled) return DriveState::kOperationEnabled;
  if (long_bits == tenon::canopen::kStatusQuickStopActive) return DriveState::kQuickStopActive;
  return DriveState::kUnknown;
}

/// Whether the motor may carry current (the brake may be off).
[[nodiscard]] constexpr bool is_energised(DriveState state) {
  return state == DriveState::kSwitchedOn || state == DriveState::kOperationEnabled ||
         state == DriveState::kQuickStopActive || state == DriveState::kFaultReactionActive;
}

[[nodiscard]] constexpr bool is_faulty(DriveState state) {
  return state == DriveState::kFault || state == DriveState::kFaultReactionActive;
}

[[nodiscard]] constexpr const char* to_string(DriveState state) {
  switch (state) {
    case DriveState::kUnknown:
      return "an unknown state";
    case DriveState::kNotReadyToSwitchOn:
      return "not ready to switch on";
    case DriveState::kSwitchOnDisabled:
      return "switch on disabled";
    case DriveState::kReadyToSwitchOn:
      return "ready to switch on";
    case DriveState::kSwitchedOn:
      return "switched on";
    case DriveState::kOperationEnabled:
      return "operation enabled";
    case DriveState::kQuickStopActive:
      return "quick stop active";
    case DriveState::kFaultReactionActive:
      return "fault reaction active";
    case DriveState::kFault:
      return "fault";
  }
  return "an unknown state";
}

}  // namespace tenon::hw::cia402
