#include "sim/devices/drive_402.h"

#include <algorithm>
#include <cmath>

namespace tenon::sim {
namespace {

constexpr std::int64_t kSelfTest_ns = 5'000'000;
constexpr double kNanosecondsPerSecond = 1e9;
constexpr std::uint32_t kServoDrive = 0x00020192;  // 1000h: CiA 402, servo drive
constexpr std::uint32_t kProductCode = 0x0402;
constexpr std::uint16_t kDecelerationObject = 0x6084;
constexpr std::uint16_t kStatusVoltageEnabled = 0x0010;
constexpr std::uint16_t kStatusRemote = 0x0200;
constexpr std::uint16_t kStatusFollowsCommand = 0x1000;
constexpr std::uint32_t kWindowOff = 0xFFFFFFFF;

// 605Ah, 605Bh, 605Ch, 605Eh and 6007h.
constexpr std::int64_t kOptionDisable = 0;
constexpr std::int64_t kOptionRamp = 1;
constexpr std::int64_t kOptionQuickStopRamp = 2;
constexpr std::int64_t kOptionQuickStopHold = 6;
constexpr std::int64_t kConnectionIgnored = 0;
constexpr std::int64_t kConnectionFault = 1;
constexpr std::int64_t kConnectionDisable = 2;

/// A late or lost SYNC finds the axis still moving on; this many periods after the last one it
/// stops.
constexpr std::int64_t kExtrapolationPeriods = 2;

std::uint32_t pdo_mapping(std::uint16_t index, std::uint8_t bits) {
  return static_cast<std::uint32_t>(index) << 16 | bits;
}

/// CiA 402's defaults: the words alone; the other PDOs are switched off.
std::vector<PdoDefaults> pdos(std::uint8_t node, std::uint32_t first, std::uint16_t word) {
  constexpr std::uint32_t kNext = 0x100;
  std::vector<PdoDefaults> defaults = {{first + node, 255, {pdo_mapping(word, 16)}}};
  for (std::uint32_t i = 1; i < 4; ++i) {
    defaults.push_back({canopen::kPdoInvalid | (first + i * kNext + node), 255, {}});
  }
  return defaults;
}

std::uint16_t base_word(Drive402::State state) {
  switch (state) {
    case Drive402::State::kNotReady:
      return canopen::kStatusNotReady;
    case Drive402::State::kSwitchOnDisabled:
      return canopen::kStatusSwitchOnDisabled;
    case Drive402::State::kReadyToSwitchOn:
      return canopen::kStatusReadyToSwitchOn;
    case Drive402::State::kSwitchedOn:
      return canopen::kStatusSwitchedOn;
    case Drive402::State::kOperationEnabled:
      return canopen::kStatusOperationEnabled;
    case Drive402::State::kQuickStopActive:
      return canopen::kStatusQuickStopActive;
    case Drive402::State::kFaultReaction:
      return canopen::kStatusFaultReaction;
    case Drive402::State::kFault:
      return canopen::kStatusFault;
  }
  return canopen::kStatusNotReady;
}

}  // namespace

const char* to_string(Drive402::State state) {
  switch (state) {
    case Drive402::State::kNotReady:
      return "not ready to switch on";
    case Drive402::State::kSwitchOnDisabled:
      return "switch on disabled";
    case Drive402::State::kReadyToSwitchOn:
      return "ready to switch on";
    case Drive402::State::kSwitchedOn:
      return "switched on";
    case Drive402::State::kOperationEnabled:
      return "operation enabled";
    case Drive402::State::kQuickStopActive:
      return "quick stop active";
    case Drive402::State::kFaultReaction:
      return "fault reaction active";
    case Drive402::State::kFault:
      return "fault";
  }
  return "unknown";
}

Drive402::Drive402(const Parameters& parameters)
    : supported_mode_(parameters.mode),
      node_({.node = parameters.node,
             .device_type = kServoDrive,
             .product_code = kProductCode,
             .name = parameters.name,
             .receive_pdos = pdos(parameters.node, canopen::kRpdo1, canopen::kControlword),
             .transmit_pdos = pdos(parameters.node, canopen::kTpdo1, canopen::kStatusword)},
            *this) {
  add_control_objects();
  add_motion_objects(parameters);
}

void Drive402::add_control_objects() {
  using enum DataType;
  using enum Access;
  const auto add = [this](std::uint16_t index, ObjectEntry entry) {
    node_.dictionary().add(object_id(index), std::move(entry));
  };
  const auto only = [](std::initializer_list<std::int64_t> allowed) {
    return [list = std::vector<std::int64_t>(allowed)](std::int64_t value) {
      return std::find(list.begin(), list.end(), value) == list.end() ? canopen::kAbortValue : 0U;
    };
  };
  add(canopen::kAbortConnectionOption, {.type = kI16,
                                        .access = kReadWrite,
                                        .value = kConnectionFault,
                                        .on_write = only({0, 1, 2, 3})});
  add(canopen::kErrorCode, {.type = kU16, .mappable = Mappable::kTransmit});
  add(canopen::kControlword, {.type = kU16,
                              .access = kReadWrite,
                              .mappable = Mappable::kReceive,
                              .on_write = [this](std::int64_t value) {
                                on_controlword(static_cast<std::uint16_t>(value));
                                return 0U;
                              }});
  add(canopen::kStatusword, {.type = kU16, .mappable = Mappable::kTransmit});
  add(canopen::kQuickStopOption,
      {.type = kI16,
       .access = kReadWrite,
       .value = kOptionQuickStopRamp,
       .on_write = only({kOptionDisable, kOptionQuickStopRamp, kOptionQuickStopHold})});
  add(canopen::kShutdownOption,
      {.type = kI16, .access = kReadWrite, .on_write = only({kOptionDisable, kOptionRamp})});
  add(canopen::kDisableOption, {.type = kI16,
                                .access = kReadWrite,
                                .value = kOptionRamp,
                                .on_write = only({kOptionDisable, kOptionRamp})});
  add(canopen::kFaultReactionOption, {.type = kI16,
                                      .access = kReadWrite,
                                      .value = kOptionQuickStopRamp,
                                      .on_write = only({kOptionDisable, kOptionQuickStopRamp})});
  add(canopen::kMode, {.type = DataType::kI8,
                       .access = kReadWrite,
                       .mappable = Mappable::kReceive,
                       .on_write = [this](std::int64_t value) {
                         if (value != 0 && value != supported_mode_) return canopen::kAbortValue;
                         node_.dictionary().set(object_id(canopen::kModeDisplay), value);
                         return 0U;
                       }});
  add(canopen::kModeDisplay, {.type = kI8, .mappable = Mappable::kTransmit});
  // Bit mode - 1.
  add(canopen::kSupportedModes, {.type = kU32, .value = std::int64_t{1} << (supported_mode_ - 1)});
}

void Drive402::add_motion_objects(const Parameters& parameters) {
  using enum DataType;
  using enum Access;
  const auto add = [this](std::uint16_t index, std::uint8_t sub, ObjectEntry entry) {
    node_.dictionary().add(object_id(index, sub), std::move(entry));
  };
  const std::int64_t deceleration = parameters.quick_stop_counts_ps2;
  add(canopen::kPositionActual, 0, {.type = kI32, .mappable = Mappable::kTransmit});
  add(canopen::kVelocityActual, 0, {.type = kI32, .mappable = Mappable::kTransmit});
  add(canopen::kTorqueActual, 0, {.type = kI16, .mappable = Mappable::kTransmit});
  add(canopen::kTargetPosition, 0,
      {.type = kI32, .access = kReadWrite, .mappable = Mappable::kReceive});
  // The window is off until it is written, as with some real drives.
  add(canopen::kFollowingWindow, 0, {.type = kU32, .access = kReadWrite});
  add(canopen::kFollowingTimeout, 0, {.type = kU16, .access = kReadWrite});
  add(kDecelerationObject, 0,
      {.type = kU32, .access = kReadWrite, .value = deceleration, .low = 1});
  add(canopen::kQuickStopDeceleration, 0,
      {.type = kU32, .access = kReadWrite, .value = deceleration, .low = 1});
  add(canopen::kInterpolationData, 0, {.type = kU8, .value = 1});
  add(canopen::kInterpolationData, 1,
      {.type = kI32, .access = kReadWrite, .mappable = Mappable::kReceive});
  add(canopen::kInterpolationPeriod, 0, {.type = kU8, .value = 2});
  add(canopen::kInterpolationPeriod, 1, {.type = kU8, .access = kReadWrite, .value = 8, .low = 1});
  add(canopen::kInterpolationPeriod, 2,
      {.type = kI8, .access = kReadWrite, .value = -3, .low = -6, .high = 0});
}

std::int64_t Drive402::option(std::uint16_t index) const {
  return node_.dictionary().value(object_id(index));
}

std::uint16_t Drive402::error_code() const {
  return static_cast<std::uint16_t>(option(canopen::kErrorCode));
}

std::int64_t Drive402::interpolation_period_ns() const {
  std::int64_t period_ns = node_.dictionary().value(object_id(canopen::kInterpolationPeriod, 1)) *
                           static_cast<std::int64_t>(kNanosecondsPerSecond);
  const std::int64_t exponent =
      node_.dictionary().value(object_id(canopen::kInterpolationPeriod, 2));
  for (std::int64_t i = exponent; i < 0; ++i) period_ns /= 10;
  return period_ns;
}

// -- Calls from the node
// ----------------------------------------------------------------------------

void Drive402::on_reset(std::int64_t now_ns) {
  ready_ns_ = now_ns + kSelfTest_ns;
  last_controlword_ = 0;
  enter_state(State::kNotReady);
}

void Drive402::on_sample() {
  ObjectDictionary& dictionary = node_.dictionary();
  dictionary.set(object_id(canopen::kPositionActual), std::llround(measurement_.position_counts));
  dictionary.set(object_id(canopen::kVelocityActual), std::llround(measurement_.velocity_countsps));
  dictionary.set(object_id(canopen::kTorqueActual), std::llround(measurement_.torque_permille));
  update_statusword();
}

void Drive402::on_sync() {
  if (motion_ != Motion::kFollowing || !interpolating()) return;
  const bool cyclic = supported_mode_ == canopen::kModeCyclicSynchronousPosition;
  const std::int64_t target = node_.dictionary().value(
      cyclic ? object_id(canopen::kTargetPosition) : object_id(canopen::kInterpolationData, 1));
  segment_start_counts_ = position_counts_;
  segment_end_counts_ = static_cast<double>(target);
  segment_elapsed_ns_ = 0;
  segment_period_ns_ = interpolation_period_ns();
}

bool Drive402::interpolating() const {
  if (option(canopen::kModeDisplay) != supported_mode_) return false;
  return supported_mode_ == canopen::kModeCyclicSynchronousPosition ||
         (last_controlword_ & canopen::kControlInterpolate) != 0;
}

void Drive402::on_connection_lost() {
  const std::int64_t how = option(canopen::kAbortConnectionOption);
  if (how == kConnectionIgnored) return;
  // Nothing moves: nothing to stop, and no fault, or every master's first reset would be one.
  if (motion_ == Motion::kBraked) return process_command(Command::kDisableVoltage);
  if (how == kConnectionFault) return fault(canopen::kEmergencyHeartbeat);
  if (how == kConnectionDisable) return process_command(Command::kDisableVoltage);
  // Quick stop. Nobody is left to command the drive: at standstill the brake takes over.
  if (state_ == State::kFaultReaction) return;
  enter_state(State::kQuickStopActive);
  ramp_down(canopen::kQuickStopDeceleration, State::kSwitchOnDisabled);
}

// -- State machine
// ----------------------------------------------------------------------------------

Drive402::Command Drive402::decode(std::uint16_t word) {
  if ((word & 0x02) == 0) return Command::kDisableVoltage;
  if ((word & 0x04) == 0) return Command::kQuickStop;
  if ((word & 0x01) == 0) return Command::kShutdown;
  return (word & 0x08) == 0 ? Command::kSwitchOn : Command::kEnableOperation;
}

void Drive402::on_controlword(std::uint16_t word) {
  const bool reset_edge = (word & ~last_controlword_ & canopen::kControlFaultReset) != 0;
  last_controlword_ = word;
  if (state_ == State::kFault) {
    if (!reset_edge) return;
    node_.clear_error(error_code());
    return enter_state(State::kSwitchOnDisabled);
  }
  process_command(decode(word));
}

void Drive402::process_command(Command command) {
  switch (state_) {
    case State::kNotReady:
    case State::kFaultReaction:
    case State::kFault:
      return;
    case State::kSwitchOnDisabled:
      if (command == Command::kShutdown) enter_state(State::kReadyToSwitchOn);
      return;
    case State::kReadyToSwitchOn:
    case State::kSwitchedOn:
      switch (command) {
        case Command::kDisableVoltage:
        case Command::kQuickStop:
          return enter_state(State::kSwitchOnDisabled);
        case Command::kShutdown:
          return enter_state(State::kReadyToSwitchOn);
        case Command::kSwitchOn:
          return enter_state(State::kSwitchedOn);
        case Command::kEnableOperation:
          return enter_state(State::kOperationEnabled);
      }
      return;
    case State::kOperationEnabled:
      switch (command) {
        case Command::kDisableVoltage:
          return enter_state(State::kSwitchOnDisabled);
        case Command::kQuickStop:
          return quick_stop();
        case Command::kShutdown:
          if (option(canopen::kShutdownOption) == kOptionDisable) {
            return enter_state(State::kReadyToSwitchOn);
          }
          return ramp_down(kDecelerationObject, State::kReadyToSwitchOn);
        case Command::kSwitchOn:
          if (option(canopen::kDisableOption) == kOptionDisable) {
            return enter_state(State::kSwitchedOn);
          }
          return ramp_down(kDecelerationObject, State::kSwitchedOn);
        case Command::kEnableOperation:
          if (motion_ == Motion::kRamping) follow_from_standstill();
          return;
      }
      return;
    case State::kQuickStopActive:
      if (command == Command::kDisableVoltage) return enter_state(State::kSwitchOnDisabled);
      if (command == Command::kEnableOperation && motion_ == Motion::kHolding) {
        enter_state(State::kOperationEnabled);
      }
      return;
  }
}

void Drive402::quick_stop() {
  const std::int64_t how = option(canopen::kQuickStopOption);
  if (how == kOptionDisable) return enter_state(State::kSwitchOnDisabled);
  enter_state(State::kQuickStopActive);
  ramp_down(canopen::kQuickStopDeceleration,
            how == kOptionQuickStopHold ? std::nullopt : std::optional(State::kSwitchOnDisabled));
}

void Drive402::enter_state(State next) {
  const State before = state_;
  state_ = next;
  switch (next) {
    case State::kOperationEnabled:
      if (before != State::kOperationEnabled) follow_from_standstill();
      break;
    case State::kQuickStopActive:
    case State::kFaultReaction:
      break;  // the ramp that brought it here goes on
    case State::kNotReady:
    case State::kSwitchOnDisabled:
    case State::kReadyToSwitchOn:
    case State::kSwitchedOn:
    case State::kFault:
      motion_ = Motion::kBraked;
      break;
  }
  if (before == State::kFault || next == State::kNotReady) {
    node_.dictionary().set(object_id(canopen::kErrorCode), 0);
  }
  update_statusword();
}

void Drive402::fault(std::uint16_t code) {
  if (state_ == State::kFault || state_ == State::kFaultReaction) return;
  node_.dictionary().set(object_id(canopen::kErrorCode), code);
  node_.raise_error(code);
  const bool ramp =
      motion_ != Motion::kBraked && option(canopen::kFaultReactionOption) == kOptionQuickStopRamp;
  enter_state(State::kFaultReaction);
  if (!ramp) return enter_state(State::kFault);
  // The demand may be far from the axis, which is why this is a fault: stop where the axis is.
  position_counts_ = measurement_.position_counts;
  velocity_countsps_ = measurement_.velocity_countsps;
  ramp_down(canopen::kQuickStopDeceleration, State::kFault);
}

void Drive402::update_statusword() {
  std::uint16_t word = base_word(state_) | kStatusRemote;
  if (state_ != State::kNotReady) word |= kStatusVoltageEnabled;
  if (state_ == State::kOperationEnabled && interpolating()) word |= kStatusFollowsCommand;
  if (outside_window_ns_ > 0 && motion_ != Motion::kBraked) word |= canopen::kStatusFollowingError;
  node_.dictionary().set(object_id(canopen::kStatusword), word);
}

// -- Motion
// -----------------------------------------------------------------------------------------

void Drive402::follow_from_standstill() {
  if (motion_ == Motion::kBraked) position_counts_ = measurement_.position_counts;
  velocity_countsps_ = 0.0;
  segment_start_counts_ = segment_end_counts_ = position_counts_;
  segment_period_ns_ = segment_elapsed_ns_ = 0;
  outside_window_ns_ = 0;
  motion_ = Motion::kFollowing;
}

void Drive402::ramp_down(std::uint16_t deceleration_object, std::optional<State> next) {
  after_standstill_ = next;
  if (motion_ == Motion::kBraked) return;
  deceleration_countsps2_ = static_cast<double>(option(deceleration_object));
  motion_ = Motion::kRamping;
}

Drive402::Demand Drive402::demand(std::int64_t step_ns) {
  const double step_s = static_cast<double>(step_ns) / kNanosecondsPerSecond;
  switch (motion_) {
    case Motion::kBraked:
      return {};
    case Motion::kHolding:
      velocity_countsps_ = 0.0;
      break;
    case Motion::kRamping: {
      const double speed = std::abs(velocity_countsps_) - deceleration_countsps2_ * step_s;
      velocity_countsps_ = speed > 0.0 ? std::copysign(speed, velocity_countsps_) : 0.0;
      position_counts_ += velocity_countsps_ * step_s;
      break;
    }
    case Motion::kFollowing: {
      const double before_counts = position_counts_;
      segment_elapsed_ns_ += step_ns;
      const std::int64_t end_ns = kExtrapolationPeriods * segment_period_ns_;
      segment_elapsed_ns_ = std::min(segment_elapsed_ns_, end_ns);
      if (segment_period_ns_ > 0) {
        const double part =
            static_cast<double>(segment_elapsed_ns_) / static_cast<double>(segment_period_ns_);
        position_counts_ =
            segment_start_counts_ + part * (segment_end_counts_ - segment_start_counts_);
      }
      velocity_countsps_ = (position_counts_ - before_counts) / step_s;
      break;
    }
  }
  return {false, position_counts_, velocity_countsps_};
}

void Drive402::measured(const Measurement& measurement, std::int64_t step_ns) {
  measurement_ = measurement;
  if (motion_ == Motion::kBraked) return;
  watch_following_error(step_ns);
  if (motion_ != Motion::kRamping || velocity_countsps_ != 0.0) return;
  motion_ = Motion::kHolding;
  if (after_standstill_) enter_state(*after_standstill_);
}

void Drive402::watch_following_error(std::int64_t step_ns) {
  const std::int64_t window = option(canopen::kFollowingWindow);
  const bool watched = window != 0 && window != kWindowOff &&
                       (motion_ == Motion::kFollowing || motion_ == Motion::kHolding);
  const double error_counts = std::abs(position_counts_ - measurement_.position_counts);
  if (!watched || error_counts <= static_cast<double>(window)) {
    outside_window_ns_ = 0;
    return;
  }
  outside_window_ns_ += step_ns;
  if (outside_window_ns_ > option(canopen::kFollowingTimeout) * 1'000'000) {
    fault(canopen::kEmergencyFollowingError);
  }
}

void Drive402::advance(std::int64_t now_ns) {
  if (state_ == State::kNotReady && now_ns >= ready_ns_) enter_state(State::kSwitchOnDisabled);
  node_.advance(now_ns);
}

}  // namespace tenon::sim
