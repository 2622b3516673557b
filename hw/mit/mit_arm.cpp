#include "hw/mit/mit_arm.h"

#include <algorithm>
#include <optional>

#include "hw/arm/describe_fault.h"
#include "hw/arm/saturation_fault.h"
#include "hw/canopen/emergency.h"
#include "hw/canopen/heartbeat.h"
#include "hw/canopen/sync.h"
#include "shared/base/time_units.h"
#include "shared/canopen/constants.h"
#include "shared/mit/constants.h"

namespace tenon::hw::mit {
namespace {

/// The robot as CANopen sees it: a sensor.
Robot sensor_alone(const Robot& robot) {
  Robot sensor = robot;
  sensor.joints.clear();
  return sensor;
}

const Robot& checked(const Robot& robot) {
  check_robot(robot);
  return robot;
}

std::vector<MotorChannel> motors_of(const Robot& robot) {
  std::vector<MotorChannel> motors;
  for (const Joint& joint : robot.joints) motors.emplace_back(joint, robot.cycle_us);
  return motors;
}

}  // namespace

MitArm::MitArm(const Cell& cell, CanBus& bus)
    : robot_(checked(cell.robot)),
      bus_(robot_, bus, counters_),
      gravity_(cell),
      sensor_bring_up_(sensor_alone(robot_)),
      motor_bring_up_(robot_),
      other_master_(sensor_alone(robot_)),
      recheck_(robot_),
      motors_(motors_of(robot_)),
      sensor_(open_sensor(robot_.sensor)),
      wrench_intake_(*sensor_.source, robot_.sensor),
      supervision_(robot_, motors_, counters_) {}

std::vector<std::string> MitArm::notes() const {
  std::vector<std::string> lines;
  for (const SettingNote& note : sensor_bring_up_.notes()) lines.push_back(describe(note, robot_));
  return lines;
}

// --- bring-up ------------------------------------------------------------------------------------

bool MitArm::prepare(std::int64_t now_ns) {
  if (state() == ArmState::kFault) {
    sensor_bring_up_.restart();
    sensor_.restart();
    motor_bring_up_.restart();
    supervision_.reset();
  }
  if (state() != ArmState::kUnconfigured) return true;
  supervision_.look_at_bus(bus_.status());
  bring_up(now_ns);
  bus_.flush();
  const bool done = motor_bring_up_.state() == MotorBringUp::State::kDone;
  if (state() == ArmState::kFault || !done) return false;
  begin(now_ns);
  return true;
}

void MitArm::bring_up(std::int64_t now_ns) {
  ReceivedFrame received;
  for (int i = 0; i < kMostFrames && bus_.receive(received); ++i) {
    if (sensor_.start != nullptr) sensor_.start->process(received.frame);
    if (sensor_bring_up_.state() == BringUp::State::kDone && sensor_.started()) {
      if (received.frame.bus == kArmBus) motor_bring_up_.process(received.frame, now_ns, bus_);
    } else {
      sensor_bring_up_.process(received.frame, now_ns, bus_);
      sensor_bring_up_.update(now_ns, bus_);
    }
  }
  sensor_bring_up_.update(now_ns, bus_);
  if (sensor_bring_up_.state() == BringUp::State::kFailed) {
    supervision_.raise(sensor_bring_up_.fault());
  }
  if (sensor_bring_up_.state() != BringUp::State::kDone) return;
  if (sensor_.start != nullptr) sensor_.start->update(now_ns, bus_);
  if (sensor_.failed()) supervision_.raise(sensor_.start->fault());
  if (!sensor_.started()) return;
  motor_bring_up_.update(now_ns, bus_);
  if (motor_bring_up_.state() == MotorBringUp::State::kFailed) {
    supervision_.raise(motor_bring_up_.fault());
  }
}

void MitArm::begin(std::int64_t now_ns) {
  for (MotorChannel& motor : motors_) motor.reset();
  wrench_intake_.reset();
  limit_ = {};
  feedback_ = {};
  granted_ = ArmRequest::kDisabled;
  cycle_open_ = wrench_late_ = false;
  next_heartbeat_ns_ = now_ns;
  recheck_.restart();
  supervision_.begin(now_ns);
}

// --- a cycle -------------------------------------------------------------------------------------

void MitArm::start_cycle(std::int64_t now_ns) noexcept {
  if (state() == ArmState::kUnconfigured) return;
  // A wrench that came late is still the newest; a motor's late answer is not this cycle's.
  const bool wrench_was_late = wrench_late_;
  cycle_open_ = false;
  (void)drain(now_ns);
  feedback_.joints_fresh = feedback_.joints_off = 0;
  const std::optional<CanFrame> request = wrench_intake_.begin_cycle();
  feedback_.wrench_fresh = wrench_was_late || wrench_late_;
  wrench_late_ = false;
  cycle_open_ = true;
  feedback_.sync_ns = now_ns;
  ++counters_.cycles;
  send(canopen::sync_frame());
  if (request) send(*request);
  send_to_motors();
  check_motors();
}

// A motor that was reset since its registers were read comes on like any other. Before the arm
// counts as enabled all are asked again.
void MitArm::check_motors() noexcept {
  if (granted_ != ArmRequest::kEnabled) {
    recheck_.restart();
  } else if (supervision_.all_on()) {
    if (const std::optional<CanFrame> question = recheck_.next()) send(*question);
    if (recheck_.fault()) supervision_.raise(*recheck_.fault());
  }
  supervision_.motors_as_set(recheck_.done());
}

bool MitArm::receive(std::int64_t now_ns, ArmFeedback& feedback) noexcept {
  if (state() != ArmState::kUnconfigured) {
    (void)drain(now_ns);
    supervision_.look_at_bus(bus_.status());
    // What they answer to the last request the executor is told in this cycle.
    supervision_.look_at_motors(granted_);
  }
  feedback = feedback_;
  feedback.force_stopped_N = supervision_.force_stopped_N();
  feedback.state = state();
  feedback.fault = fault();
  const bool all = feedback_.joints_fresh == (1U << motors_.size()) - 1U;
  return cycle_open_ && all && wrench_intake_.answered();
}

bool MitArm::attend(std::int64_t now_ns) noexcept {
  return state() != ArmState::kUnconfigured && drain(now_ns) > 0;
}

void MitArm::command(std::int64_t now_ns, ArmRequest request,
                     const JointVector& position) noexcept {
  if (state() == ArmState::kUnconfigured) return;
  const bool was_enabled = state() == ArmState::kEnabled;
  supervision_.look_at_bus(bus_.status());
  if (cycle_open_) supervision_.look_at_answers(feedback_, now_ns);
  cycle_open_ = false;
  if (was_enabled && request == ArmRequest::kEnabled) supervision_.look_at_setpoints(position);
  supervision_.advance(now_ns, request);
  const bool follow = was_enabled && state() == ArmState::kEnabled;
  decide(supervision_.granted(request), follow, position);
  send_heartbeat(now_ns);
  supervision_.look_at_sending(bus_.status());
  bus_.flush();
}

// What stops does not wait for the next cycle.
void MitArm::decide(ArmRequest request, bool follow, const JointVector& position) noexcept {
  const JointVector gravity_Nm = gravity_.effort(feedback_.position, {}, {});
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    motors_[i].update(request, follow, position[i], gravity_Nm[i]);
  }
  const bool stops = request != granted_ && request != ArmRequest::kEnabled;
  granted_ = request;
  if (stops) send_to_motors();
}

// --- frames --------------------------------------------------------------------------------------

int MitArm::drain(std::int64_t now_ns) noexcept {
  ReceivedFrame received;
  int taken = 0;
  while (taken < kMostFrames && bus_.receive(received)) {
    take(received, now_ns);
    ++taken;
  }
  return taken;
}

void MitArm::take(const ReceivedFrame& received, std::int64_t now_ns) noexcept {
  const CanFrame& frame = received.frame;
  if (take_motor(frame) || take_wrench(received)) return;
  if (others_own(frame)) {
    ++counters_.unexpected_frames;
    supervision_.raise({ArmFaultKind::kOtherMaster, 0, 0, frame.id});
  } else if (const auto heartbeat = canopen::decode_heartbeat(frame)) {
    supervision_.heard(*heartbeat, now_ns);
  } else if (const auto emergency = canopen::decode_emergency(frame)) {
    supervision_.heard(*emergency);
  } else {
    ++counters_.unexpected_frames;
  }
}

bool MitArm::take_motor(const CanFrame& frame) noexcept {
  if (frame.extended || frame.remote || frame.bus != kArmBus) return false;
  const auto found = std::find_if(motors_.begin(), motors_.end(), [&](const MotorChannel& motor) {
    return motor.feedback_id() == frame.id;
  });
  if (found == motors_.end()) return false;
  if (recheck_.take(frame)) return true;
  if (!found->take_feedback(frame)) {
    ++counters_.malformed_frames;
    return true;
  }
  const auto i = static_cast<std::size_t>(found - motors_.begin());
  if (!cycle_open_) ++counters_.late_frames;
  feedback_.position[i] = found->position();
  feedback_.effort[i] = found->effort();
  feedback_.joints_fresh |= 1U << i;
  if (found->on()) {
    feedback_.joints_off &= ~(1U << i);
  } else {
    feedback_.joints_off |= 1U << i;
  }
  return true;
}

bool MitArm::take_wrench(const ReceivedFrame& received) noexcept {
  const std::uint64_t torn_before = wrench_intake_.torn();
  const WrenchSource::Taken taken = wrench_intake_.take(received.frame, received.time_ns);
  if (taken == WrenchSource::Taken::kForeign) return false;
  if (taken == WrenchSource::Taken::kMalformed) {
    ++counters_.malformed_frames;
    return true;
  }
  if (!cycle_open_ && wrench_intake_.can_be_late()) ++counters_.late_frames;
  counters_.wrench_halves_torn += wrench_intake_.torn() - torn_before;
  if (const auto& force_N = wrench_intake_.force_N()) {
    const double external_N = (*force_N - limit_.unloaded_N).norm();
    if (external_N > limit_.limit_N && supervision_.force_exceeded(external_N)) {
      decide(ArmRequest::kQuickStop, false, {});
      bus_.flush();
    }
  }
  if (const auto& end = wrench_intake_.saturated()) {
    supervision_.raise(saturation_fault(robot_.sensor.node, *end));
  }
  if (const auto& status = wrench_intake_.unwell()) {
    supervision_.raise(unwell_fault(robot_.sensor.node, *status));
  }
  if (const auto& sample = wrench_intake_.sample()) {
    feedback_.wrench = sample->wrench;
    feedback_.wrench_counter = sample->counter;
    feedback_.wrench_fresh = true;
    wrench_late_ = !cycle_open_;
  }
  return true;
}

/// What only a master sends: it never hears itself.
bool MitArm::others_own(const CanFrame& frame) const noexcept {
  if (other_master_.sent(frame)) return true;
  if (frame.extended || frame.remote || frame.bus != kArmBus) return false;
  return frame.id == tenon::mit::kRegisterId ||
         std::any_of(motors_.begin(), motors_.end(),
                     [&](const MotorChannel& motor) { return motor.node() == frame.id; });
}

void MitArm::send(const CanFrame& frame) noexcept {
  const SendResult result = bus_.send(frame);
  if (result == SendResult::kSent) return;
  ++counters_.send_failures;
  if (result == SendResult::kQueueFull) return supervision_.frame_refused();
  supervision_.look_at_bus(bus_.status());
  supervision_.raise({ArmFaultKind::kBusDown});
}

void MitArm::send_to_motors() noexcept {
  for (const MotorChannel& motor : motors_) send(motor.next_frame());
}

void MitArm::send_heartbeat(std::int64_t now_ns) noexcept {
  if (now_ns < next_heartbeat_ns_) return;
  send(canopen::heartbeat_frame({robot_.master_node, tenon::canopen::kStateOperational}));
  const std::int64_t period_ns = robot_.heartbeat_ms * kNanosecondsPerMillisecond;
  next_heartbeat_ns_ = std::max(next_heartbeat_ns_, now_ns - period_ns) + period_ns;
}

}  // namespace tenon::hw::mit
