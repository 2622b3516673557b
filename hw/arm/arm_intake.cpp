#include "hw/arm/arm_intake.h"

#include <algorithm>
#include <span>

#include "hw/arm/cob_ids.h"
#include "hw/arm/saturation_fault.h"
#include "hw/canopen/emergency.h"
#include "hw/canopen/heartbeat.h"
#include "hw/cia402/drive_state.h"
#include "shared/canopen/constants.h"

namespace tenon::hw {

ArmIntake::ArmIntake(const Robot& robot, std::span<JointChannel> joints,
                     WrenchSource& wrench_source, ArmSupervision& supervision,
                     ArmCounters& counters)
    : joints_(joints),
      sensor_node_(robot.sensor.node),
      other_master_(robot),
      supervision_(supervision),
      counters_(counters),
      wrench_intake_(wrench_source, robot.sensor) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    feedback_ids_[i] = joint_feedback_cob_id(robot, i);
  }
}

void ArmIntake::reset() noexcept {
  for (JointChannel& joint : joints_) {
    joint.reset();
  }
  wrench_intake_.reset();
  limit_ = {};
  feedback_ = {};
  cycle_open_ = wrench_late_ = false;
}

void ArmIntake::forget_freshness() noexcept {
  feedback_.joints_fresh = 0;
  feedback_.joints_off = 0;
}

std::optional<CanFrame> ArmIntake::open_cycle(std::int64_t now_ns, CanBus& bus) noexcept {
  // A wrench that came late is still the newest; a joint's late answer is not this cycle's.
  feedback_.wrench_fresh = wrench_late_;
  forget_freshness();
  cycle_open_ = false;
  (void)drain(now_ns, bus);
  forget_freshness();
  wrench_late_ = false;
  cycle_open_ = true;
  feedback_.sync_ns = now_ns;
  return wrench_intake_.begin_cycle();
}

bool ArmIntake::close_cycle() noexcept {
  const bool was_open = cycle_open_;
  cycle_open_ = false;
  return was_open;
}

bool ArmIntake::complete() const noexcept {
  return cycle_open_ && feedback_.joints_fresh == (1u << joints_.size()) - 1u &&
         wrench_intake_.answered();
}

int ArmIntake::drain(std::int64_t now_ns, CanBus& bus) noexcept {
  ReceivedFrame received;
  int taken = 0;
  while (taken < kMaxFramesPerCall && bus.receive(received)) {
    take_received(received, now_ns);
    ++taken;
  }
  return taken;
}

void ArmIntake::take_received(const ReceivedFrame& received, std::int64_t now_ns) noexcept {
  const CanFrame& frame = received.frame;
  if (take_process_data(received)) {
    return;
  }
  if (other_master_.sent(frame)) {
    ++counters_.unexpected_frames;
    supervision_.raise({ArmFaultKind::kOtherMaster, 0, 0, frame.id});
  } else if (const auto heartbeat = canopen::decode_heartbeat(frame)) {
    supervision_.take_heartbeat(*heartbeat, now_ns);
  } else if (const auto emergency = canopen::decode_emergency(frame)) {
    supervision_.take_emergency(*emergency);
  } else {
    ++counters_.unexpected_frames;
  }
}

bool ArmIntake::take_process_data(const ReceivedFrame& received) noexcept {
  const CanFrame& frame = received.frame;
  if (frame.extended || frame.remote) {
    return false;
  }
  if (take_wrench_frame(received)) {
    return true;
  }
  if (frame.bus != kArmBus) return false;
  const auto ids = std::span(feedback_ids_).first(joints_.size());
  const auto found = std::find(ids.begin(), ids.end(), frame.id);
  if (found == ids.end()) {
    return false;
  }
  const auto i = static_cast<std::size_t>(found - ids.begin());
  if (!joints_[i].take_feedback(frame)) {
    ++counters_.malformed_frames;
    supervision_.take_wrong_length(joints_[i].node(), frame.length);
    return true;
  }
  counters_.late_frames += cycle_open_ ? 0 : 1;
  feedback_.position[i] = joints_[i].position();
  feedback_.effort[i] = joints_[i].effort();
  feedback_.joints_fresh |= 1u << i;
  if (!cia402::is_energised(joints_[i].state())) feedback_.joints_off |= 1u << i;
  return true;
}

bool ArmIntake::take_wrench_frame(const ReceivedFrame& received) noexcept {
  const std::uint64_t torn_before = wrench_intake_.torn();
  switch (wrench_intake_.take(received.frame, received.time_ns)) {
    case WrenchSource::Taken::kForeign:
      return false;
    case WrenchSource::Taken::kMalformed:
      ++counters_.malformed_frames;
      supervision_.take_wrong_length(sensor_node_, received.frame.length);
      return true;
    case WrenchSource::Taken::kHalf:
      break;
  }
  if (wrench_intake_.force_N()) judge_force(*wrench_intake_.force_N());
  if (const auto& end = wrench_intake_.saturated()) {
    supervision_.raise(saturation_fault(sensor_node_, *end));
  }
  if (wrench_intake_.unwell()) {
    supervision_.raise(unwell_fault(sensor_node_, *wrench_intake_.unwell()));
  }
  counters_.late_frames += cycle_open_ || !wrench_intake_.can_be_late() ? 0 : 1;
  counters_.wrench_halves_torn += wrench_intake_.torn() - torn_before;
  if (wrench_intake_.sample()) take_wrench(*wrench_intake_.sample());
  return true;
}

// The force alone tells: its other half, and whether it is new, need not be waited for.
void ArmIntake::judge_force(const Vector3& force_N) noexcept {
  const double external_N = (force_N - limit_.unloaded_N).norm();
  if (external_N > limit_.limit_N) supervision_.force_exceeded(external_N);
}

void ArmIntake::take_wrench(const WrenchIntake::Sample& sample) noexcept {
  feedback_.wrench = sample.wrench;
  wrench_late_ = !cycle_open_;
  feedback_.wrench_counter = sample.counter;
  feedback_.wrench_fresh = true;
}

}  // namespace tenon::hw
