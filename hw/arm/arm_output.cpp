#include "hw/arm/arm_output.h"

#include <span>

#include "hw/arm/cob_ids.h"
#include "hw/canopen/heartbeat.h"
#include "hw/canopen/nmt.h"
#include "hw/canopen/sync.h"
#include "shared/base/bytes.h"
#include "shared/base/time_units.h"
#include "shared/canopen/constants.h"

namespace tenon::hw {

ArmOutput::ArmOutput(const Robot& robot, CanBus& bus, std::span<JointChannel> joints,
                     ArmSupervision& supervision, ArmCounters& counters)
    : bus_(bus),
      joints_(joints),
      master_node_(robot.master_node),
      packed_(robot.targets_per_frame == 2),
      heartbeat_ns_(robot.heartbeat_ms * kNanosecondsPerMillisecond),
      supervision_(supervision),
      counters_(counters) {}

bool ArmOutput::send(const CanFrame& frame) noexcept {
  switch (bus_.send(frame)) {
    case SendResult::kSent:
      return true;
    case SendResult::kQueueFull:
      ++counters_.send_failures;
      supervision_.frame_refused();
      return false;
    case SendResult::kDown:
      ++counters_.send_failures;
      supervision_.bus_lost(bus_.status());
      return true;
  }
  return true;
}

void ArmOutput::send_sync() noexcept { send(canopen::sync_frame()); }

void ArmOutput::send_setpoints(ArmRequest request, bool follow,
                               const JointVector& position) noexcept {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (!joints_[i].seen()) {
      continue;
    }
    // That all are numbers has been seen to.
    const bool ran_on = joints_[i].runs_on();
    (void)joints_[i].update(request, follow, position[i]);
    if (joints_[i].runs_on() && !ran_on) ++counters_.unbraked_axes;
    if (!packed_ && !send(joints_[i].command_frame())) {
      supervision_.setpoint_refused(i);
    }
  }
  if (packed_) {
    send_packed_setpoints();
  }
}

void ArmOutput::send_packed_setpoints() noexcept {
  // Controlwords first: a stop waits for no target.
  for (JointChannel& joint : joints_) {
    if (!joint.seen()) {
      continue;
    }
    if (const auto frame = joint.due_controlword_frame()) {
      send(*frame);
    }
  }
  for (std::size_t i = 0; i < joints_.size(); i += 2) {
    const JointChannel* second = i + 1 < joints_.size() ? &joints_[i + 1] : nullptr;
    if (joints_[i].seen() && (second == nullptr || second->seen())) {
      if (send(joints_[i].targets_frame(second))) continue;
      supervision_.setpoint_refused(i);
      if (second != nullptr) supervision_.setpoint_refused(i + 1);
    }
  }
}

void ArmOutput::send_starts() noexcept {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (!supervision_.take_missed_us(i)) continue;
    send(canopen::nmt_frame(tenon::canopen::kNmtStart, joints_[i].node()));
  }
}

void ArmOutput::send_stop() noexcept {
  CanFrame frame;
  frame.id = kStopCobId;
  frame.length = 2;
  store_le(std::span(frame.data), tenon::canopen::kCommandQuickStop);
  send(frame);
}

void ArmOutput::send_heartbeat(std::int64_t now_ns) noexcept {
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
