#include "sim/cell/devices/mit_drive.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "shared/mit/constants.h"
#include "shared/mit/robot_motors.h"

namespace tenon::sim {
namespace {

constexpr double kCountsOfRange = 65535.0;
constexpr double kPermilleOfRated = 1000.0;
constexpr double kFriction_Nm = 0.5;              // chosen
constexpr double kFrictionDamping_Nmsprad = 1e6;  // so that friction is dry
constexpr std::uint8_t kRoom_degC = 25;
constexpr std::uint32_t kModePositionVelocity = 2;
constexpr std::int64_t kMicrosecond_ns = 1000;

std::uint32_t float_bits(double value) {
  return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

const char* text_of(std::uint8_t state) {
  switch (state) {
    case mit::kStateOff:
      return "off";
    case mit::kStateOn:
      return "on";
    case mit::kErrorLostMaster:
      return "error: lost communication";
  }
  return "error";
}

bool is_special(const CanFrame& frame) {
  for (std::size_t i = 0; i + 1 < frame.data.size(); ++i) {
    if (frame.data[i] != mit::kFiller) return false;
  }
  return frame.data[7] >= mit::kClearError && frame.data[7] <= mit::kSaveZero;
}

}  // namespace

MitDrive::MitDrive(const Joint& joint)
    : number_(joint.node),
      rated_effort_(joint.rated_effort),
      counts_per_unit_(joint.counts_per_unit),
      state_(mit::kStateOff) {
  const MitMotor& motor = mit_motor(joint);
  defaults_ = {{mit::kMasterId, motor.feedback_id},
               {mit::kMotorId, joint.node},
               {mit::kTimeout, 0},
               {mit::kControlMode, kModePositionVelocity},
               {mit::kPositionMax, float_bits(motor.position_max_rad)},
               {mit::kVelocityMax, float_bits(motor.velocity_max_radps)},
               {mit::kTorqueMax, float_bits(motor.torque_max_Nm)}};
  registers_ = defaults_;
}

double MitDrive::real(std::uint8_t number) const {
  return double{std::bit_cast<float>(registers_.at(number))};
}

MotorRanges MitDrive::ranges() const {
  return {real(mit::kPositionMax), real(mit::kVelocityMax), real(mit::kTorqueMax)};
}

/// Of the motor's own angle; the joint may count the other way.
double MitDrive::counts_per_rad() const { return 0.5 * kCountsOfRange / real(mit::kPositionMax); }

// --- frames --------------------------------------------------------------------------------------

void MitDrive::power_on(std::int64_t now_ns) {
  now_ns_ = heard_ns_ = now_ns;
  registers_ = defaults_;
  outbox_.clear();
  enter_state(mit::kStateOff);
}

void MitDrive::receive(const CanFrame& frame, std::int64_t now_ns) {
  if (silent_ || frame.extended || frame.remote || frame.length != 8) return;
  if (frame.id == mit::kRegisterId) return on_register(frame);
  if (frame.id != registers_.at(mit::kMotorId)) return;
  heard_ns_ = now_ns;
  if (is_special(frame)) {
    on_special(frame.data[7]);
  } else if (state_ == mit::kStateOn && registers_.at(mit::kControlMode) == mit::kModeMit) {
    order_ = read_order(frame, ranges());
    let_go_ = true;
  }
  answer();
}

void MitDrive::on_register(const CanFrame& frame) {
  const auto whose = static_cast<std::uint32_t>(frame.data[1] << 8U | frame.data[0]);
  const auto found = registers_.find(frame.data[3]);
  const bool write = frame.data[2] == mit::kWriteRegister;
  const bool whole = frame.data[2] == mit::kRequestFeedback;
  if (whole && whose == registers_.at(mit::kMotorId)) return answer();
  if (whose != registers_.at(mit::kMotorId) || found == registers_.end()) return;
  if (!write && frame.data[2] != mit::kReadRegister) return;
  if (write && state_ != mit::kStateOn) {
    found->second = 0;
    for (unsigned i = 4; i < 8; ++i) {
      found->second |= std::uint32_t{frame.data[i]} << (8U * (i - 4));
    }
  }
  CanFrame reply = frame;
  reply.id = registers_.at(mit::kMasterId);
  for (unsigned i = 4; i < 8; ++i) {
    reply.data[i] = static_cast<std::uint8_t>(found->second >> (8U * (i - 4)));
  }
  outbox_.push_back(reply);
}

void MitDrive::on_special(std::uint8_t what) {
  const bool faulted = state_ != mit::kStateOn && state_ != mit::kStateOff;
  if (what == mit::kEnable && !faulted) enter_state(mit::kStateOn);
  if (what == mit::kDisable && !faulted) enter_state(mit::kStateOff);
  if (what == mit::kClearError && faulted) enter_state(mit::kStateOff);
}

void MitDrive::enter_state(std::uint8_t state) {
  if (state == state_) return;
  state_ = state;
  order_.reset();
  frozen_rad_.reset();
}

void MitDrive::answer() {
  MotorReport report;
  report.state = state_;
  report.number = number_ & 0x0FU;
  report.position_rad = measurement_.position_counts / counts_per_rad() - real(mit::kPositionMax);
  report.velocity_radps = measurement_.velocity_countsps / counts_per_rad();
  // Effort comes in the joint's direction.
  report.torque_Nm =
      std::copysign(1.0, counts_per_unit_) * torque_permille_ / kPermilleOfRated * rated_effort_;
  report.board_degC = report.coil_degC = kRoom_degC;
  outbox_.push_back(report_frame(registers_.at(mit::kMasterId), report, ranges()));
}

void MitDrive::take(std::vector<CanFrame>& frames) {
  if (!silent_) frames.insert(frames.end(), outbox_.begin(), outbox_.end());
  outbox_.clear();
}

// --- axis ----------------------------------------------------------------------------------------

VirtualDrive::Demand MitDrive::demand(std::int64_t /*step_ns*/) {
  Demand demand;
  demand.brake = !let_go_;
  demand.powered = state_ == mit::kStateOn;
  demand.position_counts = measurement_.position_counts;
  demand.impedance = Impedance{};
  const Fault* loss = faults_.find(FaultKind::kTorqueLoss);
  demand.torque_max_permille = kPermilleOfRated * real(mit::kTorqueMax) / rated_effort_ *
                               (loss == nullptr ? 1.0 : loss->value);
  if (!demand.powered && let_go_) {
    // Nothing but the gear's friction is left, which brings a fallen arm to rest.
    demand.powered = true;
    demand.torque_max_permille = kPermilleOfRated * kFriction_Nm / rated_effort_;
    demand.impedance = Impedance{0.0, kFrictionDamping_Nmsprad, 0.0};
  }
  if (state_ != mit::kStateOn || !order_) return demand;
  double position_rad = order_->position_rad - jump_rad_;
  double velocity_radps = order_->velocity_radps;
  if (faults_.find(FaultKind::kFrozenDrive) == nullptr) {
    frozen_rad_.reset();
  } else {
    if (!frozen_rad_) frozen_rad_ = position_rad;
    position_rad = *frozen_rad_;
    velocity_radps = 0.0;
  }
  demand.position_counts = (position_rad + real(mit::kPositionMax)) * counts_per_rad();
  demand.velocity_countsps = velocity_radps * counts_per_rad();
  demand.impedance = Impedance{order_->stiffness_Nmprad, order_->damping_Nmsprad,
                               std::copysign(1.0, counts_per_unit_) * order_->torque_Nm};
  return demand;
}

void MitDrive::measured(const Measurement& measurement, std::int64_t /*step_ns*/) {
  measurement_ = measurement;
  measurement_.position_counts += jump_rad_ * counts_per_rad();
  if (faults_.find(FaultKind::kFrozenEffort) != nullptr) return;
  const double off = state_ == mit::kStateOn ? measurement.torque_off_permille : 0.0;
  torque_permille_ = measurement.torque_permille + off;
}

// --- time and faults -----------------------------------------------------------------------------

void MitDrive::advance(std::int64_t now_ns) {
  now_ns_ = now_ns;
  faults_.advance(now_ns);
  silent_ = faults_.find(FaultKind::kSilentNode) != nullptr;
  const std::int64_t timeout_ns =
      std::int64_t{registers_.at(mit::kTimeout)} * mit::kTimeoutUnit_us * kMicrosecond_ns;
  if (state_ == mit::kStateOn && timeout_ns > 0 && now_ns - heard_ns_ > timeout_ns) {
    enter_state(mit::kErrorLostMaster);
  }
}

bool MitDrive::can_have(const Fault& fault) const {
  constexpr std::array kKinds = {FaultKind::kNodeReset,   FaultKind::kSilentNode,
                                 FaultKind::kEncoderJump, FaultKind::kTorqueLoss,
                                 FaultKind::kFrozenDrive, FaultKind::kFrozenEffort};
  if (fault.kind == FaultKind::kEmergency) {
    return fault.value >= mit::kErrorOverVoltage && fault.value <= mit::kErrorOverload;
  }
  return std::find(kKinds.begin(), kKinds.end(), fault.kind) != kKinds.end();
}

void MitDrive::inject(const Fault& fault) {
  if (!can_have(fault) || !happens(fault)) return;
  if (fault.kind == FaultKind::kNodeReset) return power_on(now_ns_);
  if (fault.kind == FaultKind::kEmergency) {
    return enter_state(static_cast<std::uint8_t>(fault.value));
  }
  if (fault.kind == FaultKind::kEncoderJump) {
    jump_rad_ += std::copysign(1.0, counts_per_unit_) * fault.value;
    return;
  }
  if (fault.kind == FaultKind::kSilentNode) silent_ = true;
  faults_.begin(fault, now_ns_);
}

VirtualDrive::Look MitDrive::look() const {
  const bool on = state_ == mit::kStateOn;
  const bool error = !on && state_ != mit::kStateOff;
  return {.state = text_of(state_),
          .switched_on = on && !order_,
          .enabled = on && order_.has_value(),
          .stopping = false,
          .faulted = error,
          .brake_engaged = false,
          .operational = !silent_,
          .error_code = static_cast<std::uint16_t>(error ? state_ : 0)};
}

}  // namespace tenon::sim
