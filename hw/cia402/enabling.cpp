#include "hw/cia402/enabling.h"

namespace tenon::hw::cia402 {
namespace {

using namespace tenon::canopen;

std::uint16_t towards_enabled(DriveState state, std::uint16_t previous, bool interpolated) {
  switch (state) {
    case DriveState::kUnknown:
    case DriveState::kNotReadyToSwitchOn:
    case DriveState::kFaultReactionActive:
      return kCommandDisableVoltage;
    case DriveState::kSwitchOnDisabled:
      return kCommandShutdown;
    case DriveState::kReadyToSwitchOn:
      return kCommandSwitchOn;
    case DriveState::kSwitchedOn:
    case DriveState::kQuickStopActive:
      return kCommandEnableOperation;
    case DriveState::kOperationEnabled:
      return interpolated ? kCommandEnableOperation | kControlInterpolate : kCommandEnableOperation;
    case DriveState::kFault:
      return (previous & kControlFaultReset) != 0 ? kCommandDisableVoltage : kControlFaultReset;
  }
  return kCommandDisableVoltage;
}

std::uint16_t towards_disabled(DriveState state) {
  switch (state) {
    case DriveState::kOperationEnabled:
      return kCommandSwitchOn;  // in this state: disable operation
    case DriveState::kSwitchedOn:
      return kCommandShutdown;
    case DriveState::kUnknown:
    case DriveState::kNotReadyToSwitchOn:
    case DriveState::kSwitchOnDisabled:
    case DriveState::kReadyToSwitchOn:
    case DriveState::kQuickStopActive:
    case DriveState::kFaultReactionActive:
    case DriveState::kFault:
      return kCommandDisableVoltage;
  }
  return kCommandDisableVoltage;
}

}  // namespace

std::uint16_t next_controlword(DriveState state, ArmRequest request, std::uint16_t previous,
                               bool interpolated) {
  switch (request) {
    case ArmRequest::kEnabled:
      return towards_enabled(state, previous, interpolated);
    case ArmRequest::kQuickStop:
      return state == DriveState::kOperationEnabled || state == DriveState::kQuickStopActive
                 ? kCommandQuickStop
                 : kCommandDisableVoltage;
    case ArmRequest::kDisabled:
      return towards_disabled(state);
  }
  return kCommandDisableVoltage;
}

bool has_followed(DriveState state, ArmRequest request) {
  switch (request) {
    case ArmRequest::kEnabled:
      return state == DriveState::kOperationEnabled;
    case ArmRequest::kQuickStop:
      return state == DriveState::kQuickStopActive || state == DriveState::kSwitchOnDisabled ||
             state == DriveState::kFault;
    case ArmRequest::kDisabled:
      return state == DriveState::kSwitchOnDisabled || state == DriveState::kFault;
  }
  return false;
}

}  // namespace tenon::hw::cia402
