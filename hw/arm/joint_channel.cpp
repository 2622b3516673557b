#include "hw/arm/joint_channel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "hw/arm/cob_ids.h"
#include "hw/cia402/enabling.h"
#include "shared/base/bytes.h"
#include "shared/canopen/constants.h"
#include "shared/canopen/robot_drives.h"

namespace tenon::hw {

using cia402::DriveState;

JointChannel::JointChannel(const Joint& joint, std::uint32_t cycle_us)
    : node_(joint.node),
      interpolated_(canopen_drive(joint).mode == DriveMode::kInterpolatedPosition),
      counts_per_unit_(joint.counts_per_unit),
      zero_counts_(joint.zero_counts),
      rated_effort_(joint.rated_effort),
      stop_patience_(static_cast<int>(std::ceil(1e6 * kStopPatience_s / cycle_us))),
      braking_(joint, cycle_us) {}

void JointChannel::reset() {
  seen_ = answered_ = reached_enabled_ = false;
  stop_cycles_ = 0;
  braking_.restart();
  request_ = ArmRequest::kDisabled;
  sent_controlword_.reset();
  statusword_ = controlword_ = 0;
  position_counts_ = target_counts_ = 0;
  effort_permille_ = 0;
}

bool JointChannel::take_feedback(const CanFrame& frame) {
  if (frame.length != 8) {
    return false;
  }
  const std::span<const std::uint8_t> bytes(frame.data);
  statusword_ = load_le<std::uint16_t>(bytes);
  effort_permille_ = load_le<std::int16_t>(bytes.subspan(2));
  position_counts_ = load_le<std::int32_t>(bytes.subspan(4));
  seen_ = answered_ = true;
  return true;
}

bool JointChannel::is_target(double setpoint) const {
  return std::isfinite(setpoint * counts_per_unit_ + zero_counts_);
}

bool JointChannel::update(ArmRequest request, bool follow, double setpoint) {
  const bool enabled = state() == DriveState::kOperationEnabled;
  bool valid = true;
  if (follow) {
    const double counts = std::round(setpoint * counts_per_unit_ + zero_counts_);
    valid = is_target(setpoint);
    if (valid) {
      target_counts_ = static_cast<std::int32_t>(
          std::clamp<double>(counts, std::numeric_limits<std::int32_t>::min(),
                             std::numeric_limits<std::int32_t>::max()));
    }
  } else if (request != ArmRequest::kEnabled || !reached_enabled_) {
    // An enabled drive that waits for the others holds where it was enabled: following its own
    // position would let it sag.
    target_counts_ = position_counts_;
  }
  reached_enabled_ = request == ArmRequest::kEnabled && (reached_enabled_ || enabled);
  watch_braking(request);
  controlword_ = next_controlword(request);
  request_ = request;
  answered_ = false;
  return valid;
}

void JointChannel::watch_braking(ArmRequest request) {
  if (request == ArmRequest::kEnabled || !cia402::is_energised(state())) return braking_.restart();
  braking_.update(position_counts_, answered_);
}

std::uint16_t JointChannel::next_controlword(ArmRequest request) {
  if (braking_.runs_on()) return tenon::canopen::kCommandDisableVoltage;
  const bool unheard = !answered_ && cia402::is_energised(state());
  const bool stopping = state() == DriveState::kQuickStopActive || unheard;
  stop_cycles_ = request == ArmRequest::kDisabled && stopping ? stop_cycles_ + 1 : 0;
  if (stop_cycles_ == 0) {
    return cia402::next_controlword(state(), request, controlword_, interpolated_);
  }
  if (stop_cycles_ <= stop_patience_) return tenon::canopen::kCommandQuickStop;
  return tenon::canopen::kCommandDisableVoltage;
}

CanFrame JointChannel::command_frame() const {
  CanFrame frame;
  frame.id = joint_command_cob_id(node_);
  frame.length = 6;
  store_le(std::span(frame.data), controlword_);
  store_le(std::span(frame.data).subspan(2), target_counts_);
  return frame;
}

CanFrame JointChannel::targets_frame(const JointChannel* second) const {
  CanFrame frame;
  frame.id = joint_command_cob_id(node_);
  frame.length = second != nullptr ? 8 : 4;
  store_le(std::span(frame.data), target_counts_);
  if (second != nullptr) store_le(std::span(frame.data).subspan(4), second->target_counts_);
  return frame;
}

std::optional<CanFrame> JointChannel::due_controlword_frame() {
  // Mode 7 obeys bit 4 without a change of state.
  const bool moves = request_ != ArmRequest::kEnabled || !interpolated_ ||
                     (statusword_ & cia402::kStatusFollowsTargets) != 0;
  if (sent_controlword_ == controlword_ && cia402::has_followed(state(), request_) && moves) {
    return std::nullopt;
  }
  sent_controlword_ = controlword_;
  CanFrame frame;
  frame.id = joint_controlword_cob_id(node_);
  frame.length = 2;
  store_le(std::span(frame.data), controlword_);
  return frame;
}

double JointChannel::position() const {
  return (static_cast<double>(position_counts_) - zero_counts_) / counts_per_unit_;
}

double JointChannel::effort() const {
  return static_cast<double>(effort_permille_) * 1e-3 * rated_effort_;
}

}  // namespace tenon::hw
