#include "hw/arm/arm_supervision.h"

#include <algorithm>
#include <cmath>

#include "hw/canopen/object_setting.h"
#include "hw/cia402/drive_state.h"
#include "shared/base/time_units.h"
#include "shared/canopen/constants.h"
#include "shared/canopen/robot_drives.h"

namespace tenon::hw {
namespace {

using canopen::object_of;
using cia402::DriveState;

std::vector<DriveProfile> drives_of(const Robot& robot) {
  std::vector<DriveProfile> drives;
  for (const Joint& joint : robot.joints) drives.push_back(canopen_drive(joint).profile);
  return drives;
}

}  // namespace

ArmSupervision::ArmSupervision(const Robot& robot, std::span<const JointChannel> joints,
                               ArmCounters& counters)
    : joints_(joints),
      drives_(drives_of(robot)),
      sensor_node_(robot.sensor.node),
      heartbeat_timeout_ns_(robot.heartbeat_timeout_ms * kNanosecondsPerMillisecond),
      counters_(counters),
      wrench_(robot.sensor) {
  for (const Joint& joint : robot.joints) {
    watch_.add(joint.node);
  }
  if (sensor_node_ != 0) watch_.add(sensor_node_);
}

void ArmSupervision::reset() noexcept {
  state_ = ArmState::kUnconfigured;
  fault_ = {};
  cause_guessed_ = false;
  force_stopped_N_ = 0.0;
  stop_due_ = false;
}

void ArmSupervision::begin(std::int64_t now_ns) noexcept {
  watch_.restart(now_ns);
  missing_cycles_.fill(0);
  warned_.fill(0);
  departures_.fill({});
  other_master_ = false;
  wrong_length_.fill(0);
  wrench_.reset();
  silent_cycles_ = refused_cycles_ = 0;
  refused_ = false;
  send_failures_.reset();
  refusals_ = 0;
  unsent_.fill(false);
  unsent_level_.fill(0.0);
  was_enabled_ = false;
  enter_state(ArmState::kDisabled, now_ns);
}

void ArmSupervision::enter_state(ArmState state, std::int64_t now_ns) noexcept {
  if (state_ != state) {
    state_ = state;
    entered_ns_ = now_ns;
  }
}

void ArmSupervision::raise(const ArmFault& fault) noexcept {
  other_master_ = other_master_ || fault.kind == ArmFaultKind::kOtherMaster;
  const bool of_sensor =
      fault.kind == ArmFaultKind::kSensorStale || (sensor_node_ != 0 && fault.node == sensor_node_);
  if (of_sensor && !sensor_relied_on_) return;
  if (state_ != ArmState::kFault) {
    state_ = ArmState::kFault;
    fault_ = fault;
  }
}

void ArmSupervision::raise_of_drive(ArmFaultKind kind, std::size_t joint) noexcept {
  const JointChannel& channel = joints_[joint];
  if (kind == ArmFaultKind::kDriveFault && warned_[joint] != 0) {
    // Most likely what it had warned of; its next EMCY knows.
    cause_guessed_ = cause_guessed_ || state_ != ArmState::kFault;
    return raise({kind, channel.node(), object_of(tenon::canopen::kErrorCode), warned_[joint]});
  }
  raise({kind, channel.node(), object_of(tenon::canopen::kStatusword), channel.statusword()});
}

// --- told as it happens --------------------------------------------------------------------------

void ArmSupervision::check_bus(const CanBusStatus& status) noexcept {
  // Bus-off first: it says why the bus is down.
  if (status.bus_off) {
    raise({ArmFaultKind::kBusOff, 0, 0, status.failed_bus});
  } else if (!status.up) {
    raise({ArmFaultKind::kBusDown, 0, 0, status.failed_bus});
  }
}

void ArmSupervision::bus_lost(const CanBusStatus& status) noexcept {
  check_bus(status);
  raise({ArmFaultKind::kBusDown, 0, 0, 0});
}

void ArmSupervision::force_exceeded(double force_N) noexcept {
  const bool on = state_ == ArmState::kEnabling || state_ == ArmState::kEnabled;
  if (!on || force_stopped_N_ > 0.0) return;
  force_stopped_N_ = force_N;
  stop_due_ = true;
}

bool ArmSupervision::take_stop() noexcept {
  const bool due = stop_due_;
  stop_due_ = false;
  return due;
}

void ArmSupervision::take_heartbeat(const canopen::Heartbeat& heartbeat,
                                    std::int64_t now_ns) noexcept {
  if (!watch_.process(heartbeat, now_ns)) {
    ++counters_.unexpected_frames;
  } else if (heartbeat.state != tenon::canopen::kStateOperational) {
    note_left(heartbeat);
    raise({ArmFaultKind::kUnexpectedReset, heartbeat.node, 0, heartbeat.state});
  }
}

std::size_t ArmSupervision::joint_of(std::uint8_t node) const noexcept {
  std::size_t at = 0;
  while (at < joints_.size() && joints_[at].node() != node) ++at;
  return at;
}

void ArmSupervision::note_left(const canopen::Heartbeat& heartbeat) noexcept {
  const std::size_t joint = joint_of(heartbeat.node);
  if (joint == joints_.size()) return;
  Departure& departure = departures_[joint];
  departure.reset = departure.reset || heartbeat.state == tenon::canopen::kStateBootUp;
  departure.waits = heartbeat.state == tenon::canopen::kStatePreOperational;
}

bool ArmSupervision::take_missed_us(std::size_t joint) noexcept {
  Departure& departure = departures_[joint];
  const bool waits = departure.waits;
  departure.waits = false;
  return waits && departure.missed_us && !departure.reset && !other_master_;
}

void ArmSupervision::take_emergency(const canopen::Emergency& emergency) noexcept {
  ++counters_.emergencies;
  if (canopen::is_warning(emergency)) {
    forget_warning(emergency);
    return;
  }
  const std::uint32_t error_code = object_of(tenon::canopen::kErrorCode);
  if (emergency.node == sensor_node_) {
    raise({ArmFaultKind::kSensorInvalid, sensor_node_, error_code, emergency.code});
    return;
  }
  const std::size_t joint = joint_of(emergency.node);
  if (joint == joints_.size()) {
    return;
  }
  const bool missed_us = emergency.code == tenon::canopen::kEmergencyHeartbeat;
  departures_[joint].missed_us = departures_[joint].missed_us || missed_us;
  // The statusword may have told first; the error code says more.
  const bool same_fault =
      fault_.kind == ArmFaultKind::kDriveFault && fault_.node == emergency.node &&
      (fault_.object == object_of(tenon::canopen::kStatusword) || cause_guessed_);
  if (same_fault) {
    cause_guessed_ = false;
    fault_.object = error_code;
    fault_.code = emergency.code;
  } else if (drives_[joint].warns(emergency.code)) {
    warned_[joint] = emergency.code;
  } else if (state_ != ArmState::kDisabled || was_enabled_) {
    // Drives that have not been on yet keep an old fault until enabling resets it.
    raise({ArmFaultKind::kDriveFault, emergency.node, error_code, emergency.code});
  }
}

// What a drive has warned of and taken back is no cause of a later fault.
void ArmSupervision::forget_warning(const canopen::Emergency& emergency) noexcept {
  if (emergency.code != 0) return;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (joints_[i].node() == emergency.node) warned_[i] = 0;
  }
}

void ArmSupervision::take_wrong_length(std::uint8_t node, std::uint8_t data_bytes) noexcept {
  wrong_length_[joint_of(node)] = static_cast<std::uint8_t>(data_bytes + 1);
}

// --- once a cycle --------------------------------------------------------------------------------

void ArmSupervision::check_heartbeats(std::int64_t now_ns) noexcept {
  if (const auto node = watch_.silent(now_ns, heartbeat_timeout_ns_)) {
    raise({ArmFaultKind::kHeartbeatLost, *node, 0, 0});
  }
}

// Where SYNC never left, nobody can answer: that has a name of its own.
void ArmSupervision::check_silence(const ArmFeedback& feedback) noexcept {
  const bool silent = feedback.joints_fresh == 0 && !feedback.wrench_fresh && !refused_;
  silent_cycles_ = silent ? silent_cycles_ + 1 : 0;
  if (silent_cycles_ > kSilentCycles) {
    raise({ArmFaultKind::kBusSilent, 0, 0, silent_cycles_});
  }
}

void ArmSupervision::check_setpoints(const JointVector& position) noexcept {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (joints_[i].is_target(position[i])) continue;
    ++counters_.invalid_setpoints;
    raise({ArmFaultKind::kSetpointNotFinite, joints_[i].node(), 0, 0});
  }
}

void ArmSupervision::check_sending(const CanBusStatus& status) noexcept {
  // An adapter that reads too slowly takes frames and drops them later: whose, nobody can tell.
  const bool dropped = send_failures_ && status.send_failures - *send_failures_ > refusals_;
  send_failures_ = status.send_failures;
  refusals_ = 0;
  check_unsent(dropped);
  refused_cycles_ = refused_ || dropped ? refused_cycles_ + 1 : 0;
  refused_ = false;
  if (refused_cycles_ > kRefusedCycles) {
    raise({ArmFaultKind::kQueueFull, 0, 0, refused_cycles_});
  }
}

void ArmSupervision::raise_missing(ArmFaultKind kind, std::uint8_t node, std::uint32_t cycles,
                                   std::uint8_t wrong_length) noexcept {
  if (wrong_length == 0) return raise({kind, node, 0, cycles});
  raise({kind, node, object_of(tenon::canopen::kTpdoMapping), wrong_length - 1u});
}

void ArmSupervision::check_unsent(bool dropped) noexcept {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    double& level = unsent_level_[i];
    level = unsent_[i] || dropped ? level + 1.0 : std::max(0.0, level - kUnsentShare);
    unsent_[i] = false;
    if (level > kUnsentMost) {
      raise({ArmFaultKind::kSetpointUnsent, joints_[i].node(), 0,
             static_cast<std::uint32_t>(std::ceil(level))});
    }
  }
}

void ArmSupervision::check_feedback(const ArmFeedback& feedback) noexcept {
  check_silence(feedback);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if ((feedback.joints_fresh >> i & 1u) != 0) {
      missing_cycles_[i] = wrong_length_[i] = 0;
      continue;
    }
    ++counters_.joint_frames_missing;
    if (++missing_cycles_[i] > kMissingCycles) {
      raise_missing(ArmFaultKind::kFeedbackMissing, joints_[i].node(), missing_cycles_[i],
                    wrong_length_[i]);
    }
  }
  check_wrench(feedback);
}

// A SYNC that nobody answered may never have left.
void ArmSupervision::check_wrench(const ArmFeedback& feedback) noexcept {
  const bool answered = feedback.joints_fresh != 0 || feedback.wrench_fresh;
  wrench_.update(feedback, answered && !refused_);
  if (feedback.wrench_fresh) wrong_length_[joints_.size()] = 0;
  counters_.wrenches_missing += wrench_.missing() ? 1 : 0;
  if (!wrench_.stale()) return;
  if (const std::uint32_t behind = wrench_.samples_behind()) {
    raise({ArmFaultKind::kSensorStale, sensor_node_, object_of(tenon::canopen::kSampleCounter),
           behind});
  }
  raise_missing(ArmFaultKind::kSensorStale, sensor_node_, wrench_.cycles(),
                wrong_length_[joints_.size()]);
}

void ArmSupervision::advance(std::int64_t now_ns, ArmRequest wanted) noexcept {
  const ArmRequest request = granted(wanted);
  check_drives(request);
  if (state_ == ArmState::kFault) {
    return;
  }
  switch (request) {
    case ArmRequest::kEnabled:
      return enable(now_ns);
    case ArmRequest::kDisabled:
    case ArmRequest::kQuickStop:
      enter_state(none_energised() ? ArmState::kDisabled : ArmState::kStopping, now_ns);
      if (wanted == ArmRequest::kDisabled && state_ == ArmState::kDisabled) force_stopped_N_ = 0.0;
      return;
  }
}

void ArmSupervision::check_drives(ArmRequest request) noexcept {
  if (state_ != ArmState::kEnabling && state_ != ArmState::kEnabled &&
      state_ != ArmState::kStopping) {
    return;
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const JointChannel& joint = joints_[i];
    // A fault from before the enabling is being reset; one after it counts.
    const bool expected_on = state_ == ArmState::kEnabled || joint.reached_enabled();
    if (cia402::is_faulty(joint.state()) && (expected_on || state_ == ArmState::kStopping)) {
      raise_of_drive(ArmFaultKind::kDriveFault, i);
    } else if (request == ArmRequest::kEnabled && expected_on &&
               joint.state() != DriveState::kOperationEnabled) {
      raise_of_drive(ArmFaultKind::kDriveState, i);
    }
  }
}

void ArmSupervision::enable(std::int64_t now_ns) noexcept {
  if (all_enabled()) {
    was_enabled_ = true;
    enter_state(ArmState::kEnabled, now_ns);
    return;
  }
  enter_state(ArmState::kEnabling, now_ns);
  if (now_ns - entered_ns_ <= kEnablingTimeout_ns) {
    return;
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (joints_[i].state() != DriveState::kOperationEnabled) {
      const bool faulty = cia402::is_faulty(joints_[i].state());
      raise_of_drive(faulty ? ArmFaultKind::kDriveFault : ArmFaultKind::kDriveState, i);
    }
  }
}

ArmRequest ArmSupervision::granted(ArmRequest request) const noexcept {
  const bool stopped = state_ == ArmState::kFault || force_stopped_N_ > 0.0;
  if (!stopped || request == ArmRequest::kDisabled) {
    return request;
  }
  return ArmRequest::kQuickStop;
}

bool ArmSupervision::all_enabled() const noexcept {
  return std::all_of(joints_.begin(), joints_.end(), [](const JointChannel& joint) {
    return joint.seen() && joint.state() == DriveState::kOperationEnabled;
  });
}

bool ArmSupervision::none_energised() const noexcept {
  return std::none_of(joints_.begin(), joints_.end(), [](const JointChannel& joint) {
    return cia402::is_energised(joint.state());
  });
}

}  // namespace tenon::hw
