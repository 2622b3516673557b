#include "hw/arm/arm_intake.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>

#include "hw/arm/cob_ids.h"
#include "hw/canopen/emergency.h"
#include "hw/canopen/heartbeat.h"
#include "hw/canopen/object_setting.h"
#include "hw/cia402/drive_state.h"
#include "shared/base/bytes.h"
#include "shared/canopen/constants.h"

namespace tenon::hw {
namespace {

constexpr std::uint8_t kBothHalves = 3;

}  // namespace

ArmIntake::ArmIntake(const Robot& robot, std::span<JointChannel> joints,
                     ArmSupervision& supervision, ArmCounters& counters)
    : joints_(joints),
      sensor_(robot.sensor),
      other_master_(robot),
      supervision_(supervision),
      counters_(counters) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    feedback_ids_[i] = joint_feedback_cob_id(robot, i);
  }
}

void ArmIntake::reset() noexcept {
  for (JointChannel& joint : joints_) {
    joint.reset();
  }
  pairing_.reset();
  limit_ = {};
  feedback_ = {};
  cycle_open_ = wrench_late_ = false;
  halves_seen_ = 0;
}

void ArmIntake::forget_freshness() noexcept {
  feedback_.joints_fresh = 0;
  feedback_.joints_off = 0;
  halves_seen_ = 0;
}

void ArmIntake::open_cycle(std::int64_t now_ns, CanBus& bus) noexcept {
  // A wrench that came late is still the newest; a joint's late answer is not this cycle's.
  feedback_.wrench_fresh = wrench_late_;
  forget_freshness();
  cycle_open_ = false;
  (void)drain(now_ns, bus);
  forget_freshness();
  wrench_late_ = false;
  cycle_open_ = true;
  feedback_.sync_ns = now_ns;
}

bool ArmIntake::close_cycle() noexcept {
  const bool was_open = cycle_open_;
  cycle_open_ = false;
  return was_open;
}

bool ArmIntake::complete() const noexcept {
  return cycle_open_ && feedback_.joints_fresh == (1u << joints_.size()) - 1u &&
         halves_seen_ == kBothHalves;
}

int ArmIntake::drain(std::int64_t now_ns, CanBus& bus) noexcept {
  ReceivedFrame received;
  int taken = 0;
  while (taken < kMaxFramesPerCall && bus.receive(received)) {
    take(received.frame, now_ns);
    ++taken;
  }
  return taken;
}

void ArmIntake::take(const CanFrame& frame, std::int64_t now_ns) noexcept {
  if (take_process_data(frame)) {
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

bool ArmIntake::take_process_data(const CanFrame& frame) noexcept {
  if (frame.extended || frame.remote) {
    return false;
  }
  const bool force = frame.id == kForceCobId;
  if (force || frame.id == kTorqueCobId) {
    take_wrench_half(force ? WrenchPairing::Half::kForce : WrenchPairing::Half::kTorque, frame);
    return true;
  }
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

void ArmIntake::take_wrench_half(WrenchPairing::Half half, const CanFrame& frame) noexcept {
  if (frame.length != 8) {
    ++counters_.malformed_frames;
    supervision_.take_wrong_length(sensor_.node, frame.length);
    return;
  }
  if (half == WrenchPairing::Half::kForce) judge_force(frame);
  counters_.late_frames += cycle_open_ ? 0 : 1;
  halves_seen_ = static_cast<std::uint8_t>(halves_seen_ | (1u << static_cast<unsigned>(half)));
  const std::uint64_t torn_before = pairing_.torn();
  const auto sample = pairing_.process(half, frame);
  counters_.wrench_halves_torn += pairing_.torn() - torn_before;
  if (sample && !sample->repeated) {
    take_wrench(*sample);
  }
}

// The force alone tells: its other half, and whether it is new, need not be waited for.
void ArmIntake::judge_force(const CanFrame& frame) noexcept {
  const std::span<const std::uint8_t> bytes(frame.data);
  Vector3 force_N;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    force_N[static_cast<Eigen::Index>(axis)] =
        sensor_.force_per_count_N * load_le<std::int16_t>(bytes.subspan(2 * axis));
  }
  const double external_N = (force_N - limit_.unloaded_N).norm();
  if (external_N > limit_.limit_N) supervision_.force_exceeded(external_N);
}

void ArmIntake::take_wrench(const WrenchPairing::Sample& sample) noexcept {
  for (std::size_t i = 0; i < 6; ++i) {
    const int counts = sample.counts[i];
    const double scale = i < 3 ? sensor_.force_per_count_N : sensor_.torque_per_count_Nm;
    const double range = i < 3 ? sensor_.force_range_N : sensor_.torque_range_Nm;
    const double value = counts * scale;
    // A range of 0 is not given; the 16 bits still end somewhere.
    if (std::abs(counts) >= 32767 || (range > 0.0 && std::abs(value) >= range)) {
      const auto sub = static_cast<std::uint8_t>(i + 1);
      supervision_.raise({ArmFaultKind::kSensorInvalid, sensor_.node,
                          canopen::object_of(tenon::canopen::kForceInputs, sub),
                          static_cast<std::uint16_t>(counts)});
    }
    feedback_.wrench[static_cast<Eigen::Index>(i)] = value;
  }
  wrench_late_ = !cycle_open_;
  feedback_.wrench_counter = sample.counter;
  feedback_.wrench_fresh = true;
}

}  // namespace tenon::hw
