#include "hw/mit/mit_supervision.h"

#include <algorithm>

#include "hw/canopen/object_setting.h"
#include "shared/base/time_units.h"
#include "shared/canopen/constants.h"

namespace tenon::hw::mit {

MitSupervision::MitSupervision(const Robot& robot, std::span<const MotorChannel> motors,
                               ArmCounters& counters)
    : motors_(motors),
      counters_(counters),
      sensor_node_(robot.sensor.node),
      heartbeat_timeout_ns_(robot.heartbeat_timeout_ms * kNanosecondsPerMillisecond),
      wrench_(robot.sensor) {
  if (sensor_node_ != 0) sensor_watch_.add(sensor_node_);
}

void MitSupervision::reset() noexcept {
  force_stopped_N_ = 0.0;
  fault_ = {};
  state_ = ArmState::kUnconfigured;
}

void MitSupervision::begin(std::int64_t now_ns) noexcept {
  sensor_watch_.restart(now_ns);
  missing_.fill(0);
  wrench_.reset();
  silent_cycles_ = refused_cycles_ = 0;
  send_failures_.reset();
  refused_ = false;
  enter_state(ArmState::kDisabled, now_ns);
}

void MitSupervision::enter_state(ArmState state, std::int64_t now_ns) noexcept {
  if (state == state_) return;
  state_ = state;
  entered_ns_ = now_ns;
}

void MitSupervision::raise(const ArmFault& fault) noexcept {
  const bool of_sensor =
      fault.kind == ArmFaultKind::kSensorStale || (sensor_node_ != 0 && fault.node == sensor_node_);
  if (of_sensor && !sensor_relied_on_) return;
  if (state_ == ArmState::kFault) return;
  state_ = ArmState::kFault;
  fault_ = fault;
}

// --- told as it happens --------------------------------------------------------------------------

void MitSupervision::look_at_bus(const CanBusStatus& status) noexcept {
  if (status.up && !status.bus_off) return;
  raise({status.bus_off ? ArmFaultKind::kBusOff : ArmFaultKind::kBusDown, 0, 0, status.failed_bus});
}

void MitSupervision::heard(const canopen::Heartbeat& heartbeat, std::int64_t now_ns) noexcept {
  if (!sensor_watch_.process(heartbeat, now_ns)) {
    ++counters_.unexpected_frames;
    return;
  }
  if (heartbeat.state == tenon::canopen::kStateOperational) return;
  raise({ArmFaultKind::kUnexpectedReset, heartbeat.node, 0, heartbeat.state});
}

void MitSupervision::heard(const canopen::Emergency& emergency) noexcept {
  ++counters_.emergencies;
  if (emergency.node != sensor_node_ || canopen::is_warning(emergency)) return;
  raise({ArmFaultKind::kSensorInvalid, sensor_node_, canopen::object_of(tenon::canopen::kErrorCode),
         emergency.code});
}

bool MitSupervision::force_exceeded(double force_N) noexcept {
  const bool first = force_stopped_N_ == 0.0;
  if (!first || (state_ != ArmState::kEnabling && state_ != ArmState::kEnabled)) return false;
  force_stopped_N_ = force_N;
  return true;
}

// --- once a cycle --------------------------------------------------------------------------------

void MitSupervision::look_at_answers(const ArmFeedback& feedback, std::int64_t now_ns) noexcept {
  if (const auto node = sensor_watch_.silent(now_ns, heartbeat_timeout_ns_)) {
    raise({ArmFaultKind::kHeartbeatLost, *node});
  }
  const bool heard = feedback.joints_fresh != 0 || feedback.wrench_fresh || refused_;
  silent_cycles_ = heard ? 0 : silent_cycles_ + 1;
  if (silent_cycles_ > kSilentCycles) raise({ArmFaultKind::kBusSilent, 0, 0, silent_cycles_});
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    const bool fresh = (feedback.joints_fresh >> i & 1U) != 0;
    missing_[i] = fresh ? 0 : missing_[i] + 1;
    counters_.joint_frames_missing += fresh ? 0 : 1;
    if (missing_[i] <= kMissingCycles) continue;
    raise({ArmFaultKind::kFeedbackMissing, motors_[i].node(), 0, missing_[i]});
  }
  wrench_.update(feedback, heard && !refused_);
  counters_.wrenches_missing += wrench_.missing() ? 1 : 0;
  if (!wrench_.stale()) return;
  if (const std::uint32_t behind = wrench_.samples_behind()) {
    raise({ArmFaultKind::kSensorStale, sensor_node_,
           canopen::object_of(tenon::canopen::kSampleCounter), behind});
  }
  raise({ArmFaultKind::kSensorStale, sensor_node_, 0, wrench_.cycles()});
}

void MitSupervision::look_at_setpoints(const JointVector& position) noexcept {
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    if (MotorChannel::is_target(position[i])) continue;
    ++counters_.invalid_setpoints;
    raise({ArmFaultKind::kSetpointNotFinite, motors_[i].node()});
  }
}

void MitSupervision::look_at_sending(const CanBusStatus& status) noexcept {
  const bool dropped = send_failures_ && status.send_failures > *send_failures_;
  send_failures_ = status.send_failures;
  refused_cycles_ = refused_ || dropped ? refused_cycles_ + 1 : 0;
  refused_ = false;
  if (refused_cycles_ > kRefusedCycles) {
    raise({ArmFaultKind::kQueueFull, 0, 0, refused_cycles_});
  }
}

void MitSupervision::advance(std::int64_t now_ns, ArmRequest wanted) noexcept {
  const ArmRequest request = granted(wanted);
  look_at_motors(request);
  if (state_ == ArmState::kFault) return;
  if (request == ArmRequest::kEnabled) return enable(now_ns);
  const bool off = std::none_of(motors_.begin(), motors_.end(),
                                [](const MotorChannel& motor) { return motor.on(); });
  enter_state(off ? ArmState::kDisabled : ArmState::kStopping, now_ns);
  if (off && wanted == ArmRequest::kDisabled) force_stopped_N_ = 0.0;
}

void MitSupervision::look_at_motors(ArmRequest asked) noexcept {
  const bool stopping = state_ == ArmState::kStopping;
  if (!stopping && state_ != ArmState::kEnabling && state_ != ArmState::kEnabled) return;
  for (const MotorChannel& motor : motors_) {
    // A fault from before the enabling is being cleared; one after it counts.
    const bool expected_on = state_ == ArmState::kEnabled || motor.reached_on();
    if (motor.faulty() && (expected_on || stopping)) {
      raise({ArmFaultKind::kDriveFault, motor.node(), 0, motor.state()});
    } else if (asked == ArmRequest::kEnabled && expected_on && !motor.on()) {
      raise({ArmFaultKind::kDriveState, motor.node(), 0, motor.state()});
    }
  }
}

bool MitSupervision::all_on() const noexcept {
  return std::all_of(motors_.begin(), motors_.end(),
                     [](const MotorChannel& motor) { return motor.on(); });
}

void MitSupervision::enable(std::int64_t now_ns) noexcept {
  const auto missing = std::find_if(motors_.begin(), motors_.end(),
                                    [](const MotorChannel& motor) { return !motor.on(); });
  const bool enabled = missing == motors_.end() && as_set_;
  enter_state(enabled ? ArmState::kEnabled : ArmState::kEnabling, now_ns);
  if (missing == motors_.end() || now_ns - entered_ns_ <= kEnablingTimeout_ns) return;
  const ArmFaultKind kind =
      missing->faulty() ? ArmFaultKind::kDriveFault : ArmFaultKind::kDriveState;
  raise({kind, missing->node(), 0, missing->state()});
}

ArmRequest MitSupervision::granted(ArmRequest wanted) const noexcept {
  const bool stands = state_ == ArmState::kFault || force_stopped_N_ > 0.0;
  return stands && wanted == ArmRequest::kEnabled ? ArmRequest::kQuickStop : wanted;
}

}  // namespace tenon::hw::mit
