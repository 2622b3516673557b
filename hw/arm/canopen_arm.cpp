#include "hw/arm/canopen_arm.h"

#include <optional>
#include <span>

#include "hw/arm/describe_fault.h"
#include "hw/arm/node_settings.h"

namespace tenon::hw {
namespace {

const Robot& checked(const Robot& robot) {
  check_robot(robot);
  return robot;
}

std::vector<JointChannel> channels_of(const Robot& robot) {
  std::vector<JointChannel> channels;
  for (const Joint& joint : robot.joints) channels.emplace_back(joint, robot.cycle_us);
  return channels;
}

}  // namespace

CanopenArm::CanopenArm(const Robot& robot, CanBus& bus)
    : robot_(checked(robot)),
      bus_(robot_, bus, counters_),
      bring_up_(robot_),
      joints_(channels_of(robot)),
      sensor_(open_sensor(robot.sensor)),
      supervision_(robot, joints_, counters_),
      intake_(robot, joints_, *sensor_.source, supervision_, counters_),
      output_(robot, bus_, joints_, supervision_, counters_) {}

std::vector<std::string> CanopenArm::notes() const {
  std::vector<std::string> lines;
  for (const SettingNote& note : bring_up_.notes()) lines.push_back(describe(note, robot_));
  return lines;
}

bool CanopenArm::prepare(std::int64_t now_ns) {
  if (state() == ArmState::kFault) {
    bring_up_.restart();
    sensor_.restart();
    supervision_.reset();
  }
  if (state() != ArmState::kUnconfigured) {
    return true;
  }
  supervision_.check_bus(bus_.status());
  run_bring_up(now_ns);
  if (state() == ArmState::kFault || bring_up_.state() != BringUp::State::kDone ||
      !sensor_.started()) {
    return false;
  }
  intake_.reset();
  output_.begin(now_ns);
  supervision_.begin(now_ns);
  return true;
}

void CanopenArm::run_bring_up(std::int64_t now_ns) {
  ReceivedFrame received;
  const auto done = [this] {
    return bring_up_.state() == BringUp::State::kDone && sensor_.started();
  };
  for (int i = 0; !done() && i < ArmIntake::kMaxFramesPerCall && bus_.receive(received); ++i) {
    bring_up_.process(received.frame, now_ns, bus_);
    bring_up_.update(now_ns, bus_);
    if (sensor_.start != nullptr) sensor_.start->process(received.frame);
  }
  bring_up_.update(now_ns, bus_);
  if (bring_up_.state() == BringUp::State::kDone && sensor_.start != nullptr) {
    sensor_.start->update(now_ns, bus_);
  }
  bus_.flush();
  if (bring_up_.state() == BringUp::State::kFailed) {
    supervision_.raise(bring_up_.fault());
  } else if (sensor_.failed()) {
    supervision_.raise(sensor_.start->fault());
  }
}

void CanopenArm::start_cycle(std::int64_t now_ns) noexcept {
  if (state() == ArmState::kUnconfigured) {
    return;
  }
  const std::optional<CanFrame> request = intake_.open_cycle(now_ns, bus_);
  stop_if_due(true);
  ++counters_.cycles;
  output_.send_sync();
  if (request) output_.send_request(*request);
}

bool CanopenArm::receive(std::int64_t now_ns, ArmFeedback& feedback) noexcept {
  if (state() != ArmState::kUnconfigured) {
    (void)intake_.drain(now_ns, bus_);
    stop_if_due(!intake_.cycle_open());
    supervision_.check_bus(bus_.status());
  }
  feedback = intake_.feedback();
  feedback.force_stopped_N = supervision_.force_stopped_N();
  feedback.state = state();
  feedback.fault = fault();
  return intake_.complete();
}

bool CanopenArm::attend(std::int64_t now_ns) noexcept {
  if (state() == ArmState::kUnconfigured) {
    return false;
  }
  const bool heard = intake_.drain(now_ns, bus_) > 0;
  stop_if_due(true);
  return heard;
}

void CanopenArm::stop_if_due(bool setpoints_wait) noexcept {
  if (!supervision_.take_stop()) {
    return;
  }
  output_.send_stop();
  if (setpoints_wait) {
    output_.send_setpoints(ArmRequest::kQuickStop, false, {});
  }
  bus_.flush();
}

void CanopenArm::command(std::int64_t now_ns, ArmRequest request,
                         const JointVector& position) noexcept {
  if (state() == ArmState::kUnconfigured) {
    return;
  }
  const bool was_enabled = state() == ArmState::kEnabled;
  supervision_.check_bus(bus_.status());
  supervision_.check_heartbeats(now_ns);
  if (intake_.close_cycle()) {
    supervision_.check_feedback(intake_.feedback());
  }
  if (was_enabled && request == ArmRequest::kEnabled) {
    supervision_.check_setpoints(position);
  }
  supervision_.advance(now_ns, request);
  if (state() == ArmState::kFault) {
    output_.send_starts();
  }
  const bool follow = was_enabled && state() == ArmState::kEnabled;
  output_.send_setpoints(supervision_.granted(request), follow, position);
  output_.send_heartbeat(now_ns);
  supervision_.check_sending(bus_.status());
  bus_.flush();
}

}  // namespace tenon::hw
