#include "hw/canopen_arm.h"

#include <cmath>
#include <cstdlib>

#include "hw/canopen/sync.h"
#include "hw/cob_ids.h"
#include "hw/node_settings.h"
#include "shared/canopen/constants.h"

namespace tenon::hw {
namespace {

using canopen::Emergency;
using canopen::Heartbeat;
using cia402::DriveState;

constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
constexpr std::uint8_t kBothHalves = 3;

const Robot& checked(const Robot& robot) {
  check_robot(robot);
  return robot;
}

constexpr std::uint32_t object_of(std::uint16_t index, std::uint32_t sub = 0) {
  return static_cast<std::uint32_t>(index) << 8 | sub;
}

}  // namespace

CanopenArm::CanopenArm(const Robot& robot, CanBus& bus)
    : bus_(bus),
      joint_count_(checked(robot).joints.size()),
      sensor_(robot.sensor),
      master_node_(robot.master_node),
      packed_(robot.targets_per_frame == 2),
      heartbeat_ns_(robot.heartbeat_ms * kNanosecondsPerMillisecond),
      heartbeat_timeout_ns_(robot.heartbeat_timeout_ms * kNanosecondsPerMillisecond),
      bring_up_(robot) {
  for (std::size_t i = 0; i < joint_count_; ++i) {
    joints_[i] = JointChannel(robot.joints[i]);
    watch_.add(robot.joints[i].node);
  }
  watch_.add(sensor_.node);
}

bool CanopenArm::prepare(std::int64_t now_ns) {
  if (state_ == ArmState::kFault) {
    bring_up_.restart();
    state_ = ArmState::kUnconfigured;
    fault_ = {};
  }
  if (state_ != ArmState::kUnconfigured) {
    return true;
  }
  supervise_bus();
  ReceivedFrame received;
  for (int i = 0; bring_up_.state() != BringUp::State::kDone && i < kMaxFramesPerCall &&
                  bus_.receive(received);
       ++i) {
    bring_up_.process(received.frame, now_ns, bus_);
    bring_up_.update(now_ns, bus_);
  }
  bring_up_.update(now_ns, bus_);
  bus_.wait(0);  // what has been sent leaves now
  if (bring_up_.state() == BringUp::State::kFailed) {
    const ArmFault& fault = bring_up_.fault();
    raise(fault.kind, fault.node, fault.object, fault.code);
  }
  if (state_ == ArmState::kFault || bring_up_.state() != BringUp::State::kDone) {
    return false;
  }
  begin_operation(now_ns);
  return true;
}

void CanopenArm::begin_operation(std::int64_t now_ns) {
  for (JointChannel& joint : joints_) {
    joint.reset();
  }
  pairing_.reset();
  watch_.restart(now_ns);
  feedback_ = {};
  cycle_open_ = false;
  halves_seen_ = 0;
  stale_cycles_ = 0;
  next_heartbeat_ns_ = now_ns;
  enter_state(ArmState::kDisabled, now_ns);
}

void CanopenArm::start_cycle(std::int64_t now_ns) noexcept {
  if (state_ == ArmState::kUnconfigured) {
    return;
  }
  // A wrench that came late is still the newest; a joint's late answer is not this cycle's.
  feedback_.wrench_fresh = false;
  feedback_.joints_fresh = 0;
  halves_seen_ = 0;
  cycle_open_ = false;
  drain(now_ns);
  feedback_.joints_fresh = 0;
  halves_seen_ = 0;
  cycle_open_ = true;
  feedback_.sync_ns = now_ns;
  ++counters_.cycles;
  send(canopen::sync_frame());
}

bool CanopenArm::receive(std::int64_t now_ns, ArmFeedback& feedback) noexcept {
  if (state_ != ArmState::kUnconfigured) {
    drain(now_ns);
    supervise_bus();
  }
  feedback_.state = state_;
  feedback_.fault = fault_;
  feedback = feedback_;
  return complete();
}

void CanopenArm::command(std::int64_t now_ns, ArmRequest request,
                         const JointVector& position) noexcept {
  if (state_ == ArmState::kUnconfigured) {
    return;
  }
  const bool was_enabled = state_ == ArmState::kEnabled;
  supervise(now_ns);
  supervise_drives(request);
  if (state_ != ArmState::kFault) {
    advance(now_ns, request);  // itself a source of faults: enabling may take too long
  }
  if (state_ == ArmState::kFault) {
    request = request == ArmRequest::kDisabled ? ArmRequest::kDisabled : ArmRequest::kQuickStop;
  }
  const bool follow = was_enabled && state_ == ArmState::kEnabled;
  send_setpoints(request, follow, position);
  send_heartbeat(now_ns);
  bus_.wait(0);  // what has been sent leaves now
}

// --- taking in -----------------------------------------------------------------------------------

void CanopenArm::drain(std::int64_t now_ns) noexcept {
  ReceivedFrame received;
  for (int i = 0; i < kMaxFramesPerCall && bus_.receive(received); ++i) {
    take(received.frame, now_ns);
  }
}

void CanopenArm::take(const CanFrame& frame, std::int64_t now_ns) noexcept {
  if (take_process_data(frame)) {
    return;
  }
  if (const auto heartbeat = canopen::decode_heartbeat(frame)) {
    take_heartbeat(*heartbeat, now_ns);
  } else if (const auto emergency = canopen::decode_emergency(frame)) {
    take_emergency(*emergency);
  } else {
    ++counters_.unexpected_frames;
  }
}

bool CanopenArm::take_process_data(const CanFrame& frame) noexcept {
  if (frame.extended || frame.remote) {
    return false;
  }
  const bool force = frame.id == kForceCobId;
  if (force || frame.id == kTorqueCobId) {
    take_wrench_half(force ? WrenchPairing::Half::kForce : WrenchPairing::Half::kTorque, frame);
    return true;
  }
  if (frame.id < kJointFeedbackCobId || frame.id >= joint_feedback_cob_id(joint_count_)) {
    return false;
  }
  const std::size_t i = frame.id - kJointFeedbackCobId;
  if (!joints_[i].take_feedback(frame)) {
    ++counters_.malformed_frames;
    return true;
  }
  counters_.late_frames += cycle_open_ ? 0 : 1;
  feedback_.position[i] = joints_[i].position();
  feedback_.effort[i] = joints_[i].effort();
  feedback_.joints_fresh |= 1u << i;
  return true;
}

void CanopenArm::take_wrench_half(WrenchPairing::Half half, const CanFrame& frame) noexcept {
  if (frame.length != 8) {
    ++counters_.malformed_frames;
    return;
  }
  counters_.late_frames += cycle_open_ ? 0 : 1;
  halves_seen_ = static_cast<std::uint8_t>(halves_seen_ | (1u << static_cast<unsigned>(half)));
  const std::uint64_t torn_before = pairing_.torn();
  const auto sample = pairing_.process(half, frame);
  counters_.wrench_halves_torn += pairing_.torn() - torn_before;
  if (!sample || sample->repeated) {
    return;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    const int counts = sample->counts[i];
    const double scale = i < 3 ? sensor_.force_per_count_N : sensor_.torque_per_count_Nm;
    const double range = i < 3 ? sensor_.force_range_N : sensor_.torque_range_Nm;
    const double value = counts * scale;
    // A range of 0 is not given; the 16 bits still end somewhere.
    if (std::abs(counts) >= 32767 || (range > 0.0 && std::abs(value) >= range)) {
      raise(ArmFaultKind::kSensorInvalid, sensor_.node,
            object_of(tenon::canopen::kForceInputs, static_cast<std::uint32_t>(i + 1)),
            static_cast<std::uint16_t>(counts));
    }
    feedback_.wrench[static_cast<Eigen::Index>(i)] = value;
  }
  feedback_.wrench_counter = sample->counter;
  feedback_.wrench_fresh = true;
}

void CanopenArm::take_heartbeat(const Heartbeat& heartbeat, std::int64_t now_ns) noexcept {
  if (!watch_.process(heartbeat, now_ns)) {
    ++counters_.unexpected_frames;
  } else if (heartbeat.state != tenon::canopen::kStateOperational) {
    raise(ArmFaultKind::kUnexpectedReset, heartbeat.node, 0, heartbeat.state);
  }
}

void CanopenArm::take_emergency(const Emergency& emergency) noexcept {
  ++counters_.emergencies;
  if (canopen::is_warning(emergency)) {
    return;
  }
  if (emergency.node == sensor_.node) {
    raise(ArmFaultKind::kSensorInvalid, sensor_.node, object_of(tenon::canopen::kErrorCode),
          emergency.code);
    return;
  }
  for (std::size_t i = 0; i < joint_count_; ++i) {
    if (joints_[i].node() != emergency.node) {
      continue;
    }
    // The statusword may have told first; the error code says more.
    const bool same_fault = fault_.kind == ArmFaultKind::kDriveFault &&
                            fault_.node == emergency.node &&
                            fault_.object == object_of(tenon::canopen::kStatusword);
    if (same_fault) {
      fault_.object = object_of(tenon::canopen::kErrorCode);
      fault_.code = emergency.code;
    } else if (state_ != ArmState::kDisabled) {
      // Drives that are off keep their fault until enabling resets it.
      raise(ArmFaultKind::kDriveFault, emergency.node, object_of(tenon::canopen::kErrorCode),
            emergency.code);
    }
  }
}

bool CanopenArm::complete() const noexcept {
  return cycle_open_ && feedback_.joints_fresh == (1u << joint_count_) - 1u &&
         halves_seen_ == kBothHalves;
}

// --- supervision and state -----------------------------------------------------------------------

void CanopenArm::supervise(std::int64_t now_ns) noexcept {
  supervise_bus();
  if (const auto node = watch_.silent(now_ns, heartbeat_timeout_ns_)) {
    raise(ArmFaultKind::kHeartbeatLost, *node, 0, 0);
  }
  if (cycle_open_) {
    supervise_feedback();
    cycle_open_ = false;
  }
}

void CanopenArm::supervise_bus() noexcept {
  const CanBusStatus status = bus_.status();
  // Bus-off first: it says why the bus is down.
  if (status.bus_off) {
    raise(ArmFaultKind::kBusOff, 0, 0, 0);
  } else if (!status.up) {
    raise(ArmFaultKind::kBusDown, 0, 0, 0);
  }
}

void CanopenArm::supervise_feedback() noexcept {
  for (std::size_t i = 0; i < joint_count_; ++i) {
    JointChannel& joint = joints_[i];
    if ((feedback_.joints_fresh >> i & 1u) != 0) {
      joint.missing_cycles = 0;
      continue;
    }
    ++counters_.joint_frames_missing;
    if (++joint.missing_cycles > kMissingCycles) {
      raise(ArmFaultKind::kFeedbackMissing, joint.node(), 0, joint.missing_cycles);
    }
  }
  if (feedback_.wrench_fresh) {
    stale_cycles_ = 0;
    return;
  }
  ++counters_.wrenches_missing;
  if (++stale_cycles_ > kMissingCycles) {
    raise(ArmFaultKind::kSensorStale, sensor_.node, 0, stale_cycles_);
  }
}

void CanopenArm::supervise_drives(ArmRequest request) noexcept {
  if (state_ != ArmState::kEnabling && state_ != ArmState::kEnabled &&
      state_ != ArmState::kStopping) {
    return;
  }
  for (std::size_t i = 0; i < joint_count_; ++i) {
    const JointChannel& joint = joints_[i];
    // A fault from before the enabling is being reset; one after it counts.
    const bool expected_on = state_ == ArmState::kEnabled || joint.reached_enabled();
    if (cia402::is_faulty(joint.state()) && (expected_on || state_ == ArmState::kStopping)) {
      raise(ArmFaultKind::kDriveFault, joint.node(), object_of(tenon::canopen::kStatusword),
            joint.statusword());
    } else if (request == ArmRequest::kEnabled && expected_on &&
               joint.state() != DriveState::kOperationEnabled) {
      raise(ArmFaultKind::kDriveState, joint.node(), object_of(tenon::canopen::kStatusword),
            joint.statusword());
    }
  }
}

void CanopenArm::advance(std::int64_t now_ns, ArmRequest request) noexcept {
  switch (request) {
    case ArmRequest::kEnabled:
      if (all_enabled()) {
        enter_state(ArmState::kEnabled, now_ns);
        return;
      }
      enter_state(ArmState::kEnabling, now_ns);
      if (now_ns - entered_ns_ > kEnablingTimeout_ns) {
        for (std::size_t i = 0; i < joint_count_; ++i) {
          const JointChannel& joint = joints_[i];
          if (joint.state() != DriveState::kOperationEnabled) {
            raise(cia402::is_faulty(joint.state()) ? ArmFaultKind::kDriveFault
                                                   : ArmFaultKind::kDriveState,
                  joint.node(), object_of(tenon::canopen::kStatusword), joint.statusword());
          }
        }
      }
      return;
    case ArmRequest::kDisabled:
    case ArmRequest::kQuickStop:
      enter_state(none_energised() ? ArmState::kDisabled : ArmState::kStopping, now_ns);
      return;
  }
}

void CanopenArm::enter_state(ArmState state, std::int64_t now_ns) noexcept {
  if (state_ != state) {
    state_ = state;
    entered_ns_ = now_ns;
  }
}

void CanopenArm::raise(ArmFaultKind kind, std::uint8_t node, std::uint32_t object,
                       std::uint32_t code) noexcept {
  if (state_ != ArmState::kFault) {
    state_ = ArmState::kFault;
    fault_ = {kind, node, object, code};
  }
}

bool CanopenArm::all_enabled() const noexcept {
  for (std::size_t i = 0; i < joint_count_; ++i) {
    if (!joints_[i].seen() || joints_[i].state() != DriveState::kOperationEnabled) {
      return false;
    }
  }
  return true;
}

bool CanopenArm::none_energised() const noexcept {
  for (std::size_t i = 0; i < joint_count_; ++i) {
    if (cia402::is_energised(joints_[i].state())) {
      return false;
    }
  }
  return true;
}

// --- sending -------------------------------------------------------------------------------------

void CanopenArm::send(const CanFrame& frame) noexcept {
  switch (bus_.send(frame)) {
    case SendResult::kSent:
      return;
    case SendResult::kQueueFull:
      ++counters_.send_failures;
      return;
    case SendResult::kDown:
      ++counters_.send_failures;
      supervise_bus();
      raise(ArmFaultKind::kBusDown, 0, 0, 0);
      return;
  }
}

void CanopenArm::send_setpoints(ArmRequest request, bool follow,
                                const JointVector& position) noexcept {
  for (std::size_t i = 0; i < joint_count_; ++i) {
    if (!joints_[i].seen()) {
      continue;  // nothing is known that could be a safe target
    }
    const bool valid = joints_[i].update(request, follow, position[i]);
    counters_.invalid_setpoints += valid ? 0 : 1;
    if (!packed_) {
      send(joints_[i].command_frame());
    }
  }
  if (packed_) {
    send_packed_setpoints();
  }
}

void CanopenArm::send_packed_setpoints() noexcept {
  // Controlwords first: a stop waits for no target.
  for (std::size_t i = 0; i < joint_count_; ++i) {
    if (!joints_[i].seen()) {
      continue;
    }
    if (const auto frame = joints_[i].due_controlword_frame()) {
      send(*frame);
    }
  }
  for (std::size_t i = 0; i < joint_count_; i += 2) {
    const JointChannel* second = i + 1 < joint_count_ ? &joints_[i + 1] : nullptr;
    if (joints_[i].seen() && (second == nullptr || second->seen())) {
      send(joints_[i].targets_frame(second));
    }
  }
}

void CanopenArm::send_heartbeat(std::int64_t now_ns) noexcept {
  if (now_ns < next_heartbeat_ns_) {
    return;
  }
  send(canopen::heartbeat_frame({master_node_, tenon::canopen::kStateOperational}));
  next_heartbeat_ns_ += heartbeat_ns_;
  if (next_heartbeat_ns_ <= now_ns) {
    next_heartbeat_ns_ = now_ns + heartbeat_ns_;
  }
}

}  // namespace tenon::hw
