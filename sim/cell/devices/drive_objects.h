#pragma once
// The objects of a drive beyond those of every node: the table of CiA 402's and of this drive's
// own, with names, rights, ranges and defaults. The references spare the firmware a search. One
// thread.

#include <cstdint>
#include <functional>

#include "shared/canopen/constants.h"
#include "sim/cell/canopen/object_dictionary.h"
#include "sim/cell/devices/drive_parameters.h"
#include "sim/cell/devices/drive_state.h"

namespace tenon::sim {

class DriveObjects {
 public:
  using Hook = std::function<std::uint32_t(std::int64_t)>;
  struct Hooks {
    Hook on_controlword;
    Hook on_mode;
  };

  /// @param dictionary must outlive this
  DriveObjects(ObjectDictionary& dictionary, const DriveParameters& parameters, const Hooks& hooks);

  [[nodiscard]] StopOptions stop_options() const;
  /// 60C2h.
  [[nodiscard]] std::int64_t interpolation_period_ns() const;

 private:
  ObjectDictionary& dictionary_;  // before the references, which its rows are

 public:
  ObjectEntry& connection_option = at(canopen::kAbortConnectionOption);
  ObjectEntry& error_code = at(canopen::kErrorCode);
  ObjectEntry& statusword = at(canopen::kStatusword);
  ObjectEntry& quick_stop_option = at(canopen::kQuickStopOption);
  ObjectEntry& shutdown_option = at(canopen::kShutdownOption);
  ObjectEntry& disable_option = at(canopen::kDisableOption);
  ObjectEntry& halt_option = at(0x605D);
  ObjectEntry& fault_reaction_option = at(canopen::kFaultReactionOption);
  ObjectEntry& mode_display = at(canopen::kModeDisplay);
  ObjectEntry& position_demand = at(0x6062);
  ObjectEntry& position_actual = at(canopen::kPositionActual);
  ObjectEntry& following_window = at(canopen::kFollowingWindow);
  ObjectEntry& following_timeout_ms = at(canopen::kFollowingTimeout);
  ObjectEntry& velocity_actual = at(canopen::kVelocityActual);
  ObjectEntry& torque_max_permille = at(0x6072);
  ObjectEntry& torque_actual = at(canopen::kTorqueActual);
  ObjectEntry& supply_mV = at(0x6079);
  ObjectEntry& target_position = at(canopen::kTargetPosition);
  ObjectEntry& position_min = at(canopen::kPositionLimits, 1);
  ObjectEntry& position_max = at(canopen::kPositionLimits, 2);
  ObjectEntry& deceleration = at(0x6084);
  ObjectEntry& quick_stop_deceleration = at(canopen::kQuickStopDeceleration);
  ObjectEntry& interpolation_data = at(canopen::kInterpolationData, 1);
  ObjectEntry& interpolation_value = at(canopen::kInterpolationPeriod, 1);
  ObjectEntry& interpolation_exponent = at(canopen::kInterpolationPeriod, 2);
  ObjectEntry& following_error = at(0x60F4);
  ObjectEntry& temperature_tenths = at(0x2030);
  ObjectEntry& warning_tenths = at(0x2031);
  ObjectEntry& fault_tenths = at(0x2032);
  ObjectEntry& supply_min_mV = at(0x2033);

 private:
  [[nodiscard]] ObjectEntry& at(std::uint16_t index, std::uint8_t sub = 0) const {
    return *dictionary_.find(object_id(index, sub));
  }
};

}  // namespace tenon::sim
