#include "sim/cell/devices/drive_state.h"

#include "shared/canopen/constants.h"

namespace tenon::sim {
namespace {

using enum DriveState;

/// The same for switched on and ready to switch on: no axis is under power.
std::optional<DriveTransition> from_unpowered(DriveCommand command) {
  switch (command) {
    case DriveCommand::kDisableVoltage:
    case DriveCommand::kQuickStop:
      return DriveTransition{kSwitchOnDisabled, DriveAction::kPowerOff, {}};
    case DriveCommand::kShutdown:
      return DriveTransition{kReadyToSwitchOn, DriveAction::kPowerOff, {}};
    case DriveCommand::kSwitchOn:
      return DriveTransition{kSwitchedOn, DriveAction::kPowerOff, {}};
    case DriveCommand::kEnableOperation:
      return DriveTransition{kSwitchedOn, DriveAction::kPowerOn, kOperationEnabled};
  }
  return std::nullopt;
}

DriveTransition quick_stop(std::int64_t option) {
  switch (option) {
    case 1:
      return {kQuickStopActive, DriveAction::kSlowRamp, kSwitchOnDisabled};
    case 2:
      return {kQuickStopActive, DriveAction::kQuickRamp, kSwitchOnDisabled};
    case 5:
      return {kQuickStopActive, DriveAction::kSlowRamp, {}};
    case 6:
      return {kQuickStopActive, DriveAction::kQuickRamp, {}};
    default:  // 0; the dictionary lets no other in
      return {kSwitchOnDisabled, DriveAction::kPowerOff, {}};
  }
}

std::optional<DriveTransition> from_enabled(DriveCommand command, const StopOptions& options) {
  switch (command) {
    case DriveCommand::kDisableVoltage:
      return DriveTransition{kSwitchOnDisabled, DriveAction::kPowerOff, {}};
    case DriveCommand::kQuickStop:
      return quick_stop(options.quick_stop);
    case DriveCommand::kShutdown:
      if (options.shutdown == 0)
        return DriveTransition{kReadyToSwitchOn, DriveAction::kPowerOff, {}};
      return DriveTransition{kOperationEnabled, DriveAction::kSlowRamp, kReadyToSwitchOn};
    case DriveCommand::kSwitchOn:
      if (options.disable == 0) return DriveTransition{kSwitchedOn, DriveAction::kPowerOff, {}};
      return DriveTransition{kOperationEnabled, DriveAction::kSlowRamp, kSwitchedOn};
    case DriveCommand::kEnableOperation:
      return DriveTransition{kOperationEnabled, DriveAction::kResume, {}};
  }
  return std::nullopt;
}

}  // namespace

DriveCommand decode_controlword(std::uint16_t word) {
  if ((word & 0x02) == 0) return DriveCommand::kDisableVoltage;
  if ((word & 0x04) == 0) return DriveCommand::kQuickStop;
  if ((word & 0x01) == 0) return DriveCommand::kShutdown;
  return (word & 0x08) == 0 ? DriveCommand::kSwitchOn : DriveCommand::kEnableOperation;
}

std::optional<DriveTransition> transition(DriveState state, DriveCommand command,
                                          const StopOptions& options, bool stopped) {
  switch (state) {
    case kNotReady:
    case kFaultReaction:
    case kFault:
      return std::nullopt;
    case kSwitchOnDisabled:
      if (command != DriveCommand::kShutdown) return std::nullopt;
      return DriveTransition{kReadyToSwitchOn, DriveAction::kKeep, {}};
    case kReadyToSwitchOn:
    case kSwitchedOn:
      return from_unpowered(command);
    case kOperationEnabled:
      return from_enabled(command, options);
    case kQuickStopActive:
      if (command == DriveCommand::kDisableVoltage) {
        return DriveTransition{kSwitchOnDisabled, DriveAction::kPowerOff, {}};
      }
      if (command != DriveCommand::kEnableOperation || options.quick_stop < 5 || !stopped) {
        return std::nullopt;
      }
      return DriveTransition{kOperationEnabled, DriveAction::kResume, {}};
  }
  return std::nullopt;
}

DriveTransition fault_transition(const StopOptions& options, bool can_ramp) {
  if (!can_ramp || options.fault_reaction == 0) return {kFault, DriveAction::kPowerOff, {}};
  const bool slow = options.fault_reaction == 1;
  return {kFaultReaction, slow ? DriveAction::kSlowRamp : DriveAction::kQuickRamp, kFault};
}

std::uint16_t state_word(DriveState state) {
  switch (state) {
    case kNotReady:
      return canopen::kStatusNotReady;
    case kSwitchOnDisabled:
      return canopen::kStatusSwitchOnDisabled;
    case kReadyToSwitchOn:
      return canopen::kStatusReadyToSwitchOn;
    case kSwitchedOn:
      return canopen::kStatusSwitchedOn;
    case kOperationEnabled:
      return canopen::kStatusOperationEnabled;
    case kQuickStopActive:
      return canopen::kStatusQuickStopActive;
    case kFaultReaction:
      return canopen::kStatusFaultReaction;
    case kFault:
      return canopen::kStatusFault;
  }
  return canopen::kStatusNotReady;
}

const char* to_string(DriveState state) {
  switch (state) {
    case kNotReady:
      return "not ready to switch on";
    case kSwitchOnDisabled:
      return "switch on disabled";
    case kReadyToSwitchOn:
      return "ready to switch on";
    case kSwitchedOn:
      return "switched on";
    case kOperationEnabled:
      return "operation enabled";
    case kQuickStopActive:
      return "quick stop active";
    case kFaultReaction:
      return "fault reaction active";
    case kFault:
      return "fault";
  }
  return "unknown";
}

}  // namespace tenon::sim
