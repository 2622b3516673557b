#include "sim/cell/devices/drive_402.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "shared/base/time_units.h"
#include "sim/cell/canopen/twin.h"

namespace tenon::sim {
namespace {

constexpr std::int64_t kSelfTest_ns = 5'000'000;
constexpr std::uint32_t kServoDrive = 0x00020192;  // 1000h: CiA 402, servo drive
constexpr std::uint32_t kDriveProductCode = 0x0402;
constexpr std::uint32_t kWindowOff = 0xFFFFFFFF;
constexpr std::uint16_t kErrorUnderVoltage = 0x3220;
constexpr std::uint16_t kErrorTemperature = 0x4310;
constexpr std::uint16_t kControlHalt = 0x0100;

constexpr std::uint16_t kStatusVoltageEnabled = 0x0010;
constexpr std::uint16_t kStatusRemote = 0x0200;
constexpr std::uint16_t kStatusTargetReached = 0x0400;  // mode 7
constexpr std::uint16_t kStatusInternalLimit = 0x0800;
constexpr std::uint16_t kStatusFollowsCommand = 0x1000;

// 6007h.
constexpr std::int64_t kConnectionIgnored = 0;
constexpr std::int64_t kConnectionFault = 1;
constexpr std::int64_t kConnectionDisable = 2;
constexpr std::int64_t kHaltQuick = 2;  // 605Dh

std::int64_t nanoseconds(double seconds) { return std::llround(seconds * kNanosecondsPerSecond); }

/// CiA 402's defaults: the words alone; the other PDOs are switched off.
std::vector<PdoDefaults> pdos(std::uint8_t node, std::uint32_t first, std::uint16_t word) {
  constexpr std::uint32_t kNext = 0x100;
  std::vector<PdoDefaults> defaults = {
      {first + node, 255, {static_cast<std::uint32_t>(word) << 16 | 16U}}};
  for (std::uint32_t i = 1; i < 4; ++i) {
    defaults.push_back({canopen::kPdoInvalid | (first + i * kNext + node), 255, {}});
  }
  return defaults;
}

}  // namespace

Drive402::Drive402(const Parameters& parameters)
    : parameters_(parameters),
      node_({.node = parameters.node,
             .device_type = kServoDrive,
             .product_code = kDriveProductCode,
             .name = parameters.name,
             .receive_pdos = pdos(parameters.node, canopen::kRpdo1, canopen::kControlword),
             .transmit_pdos = pdos(parameters.node, canopen::kTpdo1, canopen::kStatusword)},
            *this),
      objects_(node_.dictionary(), parameters,
               {.on_controlword =
                    [this](std::int64_t value) {
                      return on_controlword(static_cast<std::uint16_t>(value));
                    },
                .on_mode = [this](std::int64_t value) { return on_mode(value); }}),
      motion_(nanoseconds(parameters.brake_release_s), nanoseconds(parameters.brake_engage_s)),
      temperature_degC_(parameters.ambient_degC) {}

void Drive402::become_twin(const DeviceFile& file) {
  make_twin(node_.dictionary(), file, node_.node());
  if (file.find(canopen::kAbortConnectionOption, 0) == nullptr) {
    set_default(objects_.connection_option, kConnectionIgnored);
  }
  objects_.mode_display.value = 0;
}

// -- Calls from the node ------------------------------------------------------------------------

void Drive402::on_reset(std::int64_t now_ns) {
  now_ns_ = now_ns;
  ready_ns_ = now_ns + kSelfTest_ns;
  last_controlword_ = 0;
  apply({State::kNotReady, DriveAction::kPowerOff, {}});
}

void Drive402::on_sync() {
  if (!interpolates() || halted_) return;
  const ObjectEntry& target = cyclic() ? objects_.target_position : objects_.interpolation_data;
  // 607Dh cuts targets; limits that exclude each other are none.
  const std::int64_t low = objects_.position_min.value;
  const std::int64_t high = objects_.position_max.value;
  const std::int64_t counts = low < high ? std::clamp(target.value, low, high) : target.value;
  motion_.set_target(static_cast<double>(counts), objects_.interpolation_period_ns());
}

void Drive402::on_connection_lost() {
  const std::int64_t how = objects_.connection_option.value;
  if (how == kConnectionIgnored) return;
  // Nothing moves: nothing to stop, and no fault, or every master's first reset would be one.
  if (!motion_.moving_freely()) return command(DriveCommand::kDisableVoltage);
  if (how == kConnectionFault) return fault(canopen::kEmergencyHeartbeat);
  if (how == kConnectionDisable) return command(DriveCommand::kDisableVoltage);
  // Quick stop. Nobody is left to command the drive: at standstill the brake takes over.
  if (state_ == State::kFaultReaction) return;
  std::optional<State> then = State::kSwitchOnDisabled;
  if (faults_.find(FaultKind::kKeepsPower) != nullptr) then.reset();
  apply({State::kQuickStopActive, DriveAction::kQuickRamp, then});
}

std::uint32_t Drive402::on_mode(std::int64_t mode) {
  if (mode != 0 && mode != parameters_.mode) return canopen::kAbortValue;
  if (mode != objects_.mode_display.value && motion_.powered()) return canopen::kAbortDeviceState;
  objects_.mode_display.value = mode;
  return 0;
}

std::uint32_t Drive402::on_controlword(std::uint16_t word) {
  const bool reset_edge = (word & ~last_controlword_ & canopen::kControlFaultReset) != 0;
  last_controlword_ = word;
  if (decode_controlword(word) == DriveCommand::kEnableOperation) enable_buffered_ = true;
  if (state_ != State::kFault) {
    command(decode_controlword(word));
    update_halt();
  } else if (reset_edge) {
    node_.clear_error(error_code());
    enter_state(State::kSwitchOnDisabled);
  }
  return 0;
}

// -- Power states -------------------------------------------------------------------------------

void Drive402::command(DriveCommand command) {
  const bool stopped = motion_.phase() == DriveMotion::Phase::kHolding;
  if (const auto next = transition(state_, command, objects_.stop_options(), stopped)) apply(*next);
}

void Drive402::apply(const DriveTransition& transition) {
  afterwards_ = transition.then;
  act(transition.action, transition.then.has_value());
  enter_state(transition.now);
}

void Drive402::act(DriveAction action, bool brake_afterwards) {
  const auto ramp = [&](const ObjectEntry& deceleration) {
    motion_.ramp_down(static_cast<double>(deceleration.value), brake_afterwards);
  };
  switch (action) {
    case DriveAction::kKeep:
      return;
    case DriveAction::kPowerOff:
      return motion_.power_off();
    case DriveAction::kPowerOn:
      return motion_.power_on(measurement_.position_counts);
    case DriveAction::kResume:
      // The enable command of every cycle must not disturb what it finds under way.
      if (motion_.phase() != DriveMotion::Phase::kFollowing && !halted_) motion_.resume();
      return;
    case DriveAction::kSlowRamp:
      return ramp(objects_.deceleration);
    case DriveAction::kQuickRamp:
      return ramp(objects_.quick_stop_deceleration);
  }
}

void Drive402::enter_state(State next) {
  if (state_ == State::kFault || next == State::kNotReady) objects_.error_code.value = 0;
  if (next != State::kOperationEnabled) halted_ = false;
  if (next != state_) {
    outside_window_ns_ = 0;
    stopped_ns_.reset();
    if (next == State::kQuickStopActive) stopped_ns_ = now_ns_;
  }
  state_ = next;
  update_statusword();
}

void Drive402::fault(std::uint16_t code) {
  if (state_ == State::kFault || state_ == State::kFaultReaction) return;
  objects_.error_code.value = code;
  node_.raise_error(code);
  const bool can_ramp = motion_.moving_freely() && supply_good();
  // The demand may be far from the axis, which is why this is a fault: stop where the axis is.
  if (can_ramp) motion_.start_from(measurement_.position_counts, measurement_.velocity_countsps);
  apply(fault_transition(objects_.stop_options(), can_ramp));
}

/// Bit 8 stops the axis under power, and lets it go on when it falls; mode 8 has no such bit.
void Drive402::update_halt() {
  if (cyclic() || state_ != State::kOperationEnabled || afterwards_) return;
  const bool wanted = (last_controlword_ & kControlHalt) != 0;
  if (wanted == halted_) return;
  halted_ = wanted;
  const bool quick = objects_.halt_option.value == kHaltQuick;
  const DriveAction stop = quick ? DriveAction::kQuickRamp : DriveAction::kSlowRamp;
  act(wanted ? stop : DriveAction::kResume, false);
  update_statusword();
}

bool Drive402::cyclic() const {
  return parameters_.mode == canopen::kModeCyclicSynchronousPosition;
}

bool Drive402::interpolates() const {
  if (objects_.mode_display.value != parameters_.mode) return false;
  return cyclic() || (last_controlword_ & canopen::kControlInterpolate) != 0;
}

void Drive402::update_statusword() {
  using Phase = DriveMotion::Phase;
  std::uint16_t word = state_word(state_) | kStatusRemote;
  const bool follows =
      state_ == State::kOperationEnabled && motion_.phase() == Phase::kFollowing && interpolates();
  if (state_ != State::kNotReady && supply_good()) word |= kStatusVoltageEnabled;
  if (objects_.temperature_tenths.value >= objects_.warning_tenths.value) {
    word |= canopen::kStatusWarning;
  }
  if (motion_.powered() && std::abs(measurement_.torque_permille) >= torque_max_permille()) {
    word |= kStatusInternalLimit;
  }
  if (follows) word |= kStatusFollowsCommand;
  if (!cyclic() &&
      (halted_ ? motion_.phase() == Phase::kHolding : follows && motion_.target_reached())) {
    word |= kStatusTargetReached;
  }
  if (cyclic() && outside_window_ns_ > 0) word |= canopen::kStatusFollowingError;
  objects_.statusword.value = word;
}

/// A fault: what a standard drive has forgotten with its quick stop, this one still has.
void Drive402::resume_stop() {
  if (!stopped_ns_ || !enable_buffered_ || faults_.find(FaultKind::kResumesStop) == nullptr) return;
  if (now_ns_ - *stopped_ns_ < objects_.interpolation_period_ns()) return;
  enable_buffered_ = false;
  if (motion_.moving_freely()) {
    apply({State::kOperationEnabled, DriveAction::kResume, {}});
  }
}

// -- Axis ---------------------------------------------------------------------------------------

Drive402::Demand Drive402::demand(std::int64_t step_ns) {
  motion_.demand(step_ns);
  Demand demand;
  demand.brake = motion_.brake().holds() && faults_.find(FaultKind::kBrakeFailure) == nullptr;
  demand.powered = motion_.powered();
  // Without power: where the axis is. The servo closes its loop on the encoder, jumps included.
  demand.position_counts =
      (demand.powered ? motion_.position_counts() : measurement_.position_counts) -
      encoder_jump_counts_;
  demand.velocity_countsps =
      demand.powered ? motion_.velocity_countsps() : measurement_.velocity_countsps;
  if (faults_.find(FaultKind::kFrozenDrive) == nullptr) {
    frozen_counts_.reset();
  } else if (demand.powered) {
    if (!frozen_counts_) frozen_counts_ = demand.position_counts;
    demand.position_counts = *frozen_counts_;
    demand.velocity_countsps = 0.0;
  }
  demand.torque_max_permille = torque_max_permille();
  return demand;
}

double Drive402::torque_max_permille() const {
  const Fault* loss = faults_.find(FaultKind::kTorqueLoss);
  return static_cast<double>(objects_.torque_max_permille.value) *
         (loss == nullptr ? 1.0 : loss->value);
}

void Drive402::measured(const Measurement& measurement, std::int64_t step_ns) {
  measurement_ = measurement;
  measurement_.position_counts += encoder_jump_counts_;
  watch_power_stage(step_ns);
  watch_following_error(step_ns);
  const Fault* slow_brake = faults_.find(FaultKind::kSlowBrake);
  const bool done = motion_.advance(step_ns, slow_brake == nullptr ? 0.0 : slow_brake->value);
  if (done && afterwards_) {
    const State next = *afterwards_;
    afterwards_.reset();
    enter_state(next);
    update_halt();
  }
  const double error_counts =
      motion_.powered() ? motion_.position_counts() - measurement_.position_counts : 0.0;
  set(objects_.position_actual, std::llround(measurement_.position_counts));
  set(objects_.velocity_actual, std::llround(measurement_.velocity_countsps));
  if (faults_.find(FaultKind::kFrozenEffort) == nullptr) {
    const double off = motion_.powered() ? measurement_.torque_off_permille : 0.0;
    set(objects_.torque_actual, std::llround(measurement_.torque_permille + off));
  }
  set(objects_.position_demand, std::llround(measurement_.position_counts + error_counts));
  set(objects_.following_error, std::llround(error_counts));
  update_statusword();
}

void Drive402::watch_following_error(std::int64_t step_ns) {
  const std::int64_t window = objects_.following_window.value;
  const bool watched = window != 0 && window != kWindowOff && !frozen_counts_ &&
                       (motion_.phase() == DriveMotion::Phase::kFollowing ||
                        motion_.phase() == DriveMotion::Phase::kHolding);
  const double error_counts = std::abs(motion_.position_counts() - measurement_.position_counts);
  if (!watched || error_counts <= static_cast<double>(window)) {
    outside_window_ns_ = 0;
    return;
  }
  outside_window_ns_ += step_ns;
  if (outside_window_ns_ > objects_.following_timeout_ms.value * 1'000'000) {
    fault(canopen::kEmergencyFollowingError);
  }
}

// -- Power stage --------------------------------------------------------------------------------

void Drive402::set_supply(double volts) { set(objects_.supply_mV, std::llround(1000.0 * volts)); }

bool Drive402::supply_good() const {
  return objects_.supply_mV.value >= objects_.supply_min_mV.value;
}

/// Losses grow with the square of the effort, and leave through one thermal resistance:
///   T' = (ambient + rise (torque / rated)^2 - T) / time constant
void Drive402::watch_power_stage(std::int64_t step_ns) {
  const double load = measurement_.torque_permille / 1000.0;
  const double target_degC = parameters_.ambient_degC + parameters_.rise_K * load * load;
  const double step_s = static_cast<double>(step_ns) / kNanosecondsPerSecond;
  temperature_degC_ +=
      (target_degC - temperature_degC_) * step_s / parameters_.thermal_time_constant_s;
  set(objects_.temperature_tenths, std::llround(10.0 * temperature_degC_));
  if (state_ == State::kNotReady) return;
  if (objects_.temperature_tenths.value >= objects_.fault_tenths.value) fault(kErrorTemperature);
  const bool switched_on = state_ == State::kSwitchedOn || state_ == State::kOperationEnabled ||
                           state_ == State::kQuickStopActive;
  if (switched_on && !supply_good()) fault(kErrorUnderVoltage);
}

// -- Time and faults ----------------------------------------------------------------------------

void Drive402::advance(std::int64_t now_ns) {
  now_ns_ = now_ns;
  faults_.advance(now_ns);
  node_.set_silent(faults_.find(FaultKind::kSilentNode) != nullptr);
  if (state_ == State::kNotReady && now_ns >= ready_ns_) enter_state(State::kSwitchOnDisabled);
  node_.advance(now_ns);
  resume_stop();
}

bool Drive402::can_have(const Fault& fault) const {
  const FaultTarget target = target_of(fault.kind);
  return target == FaultTarget::kNode || target == FaultTarget::kDrive;
}

VirtualDrive::Look Drive402::look() const {
  return {.state = to_string(state_),
          .switched_on = state_ == State::kSwitchedOn,
          .enabled = state_ == State::kOperationEnabled,
          .stopping = stopping(),
          .faulted = state_ == State::kFault,
          .brake_engaged = brake_engaged(),
          .operational = node_.state() == NmtState::kOperational,
          .error_code = error_code()};
}

void Drive402::inject(const Fault& fault) {
  if (!can_have(fault) || !happens(fault)) return;
  if (fault.kind == FaultKind::kNodeReset) return node_.power_on(now_ns_);
  if (fault.kind == FaultKind::kEmergency) return this->fault(emergency_code(fault));
  if (fault.kind == FaultKind::kEncoderJump) {
    encoder_jump_counts_ += fault.value * parameters_.counts_per_unit;
    return;
  }
  if (fault.kind == FaultKind::kSilentNode) node_.set_silent(true);
  faults_.begin(fault, now_ns_);
}

}  // namespace tenon::sim
