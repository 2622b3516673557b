#include "hw/arm/frame_set.h"

#include <utility>

#include "hw/arm/cob_ids.h"
#include "shared/canopen/constants.h"

namespace tenon::hw {
namespace {

constexpr std::uint32_t kMicrosecondsPerMillisecond = 1000;
constexpr std::uint32_t kMicrosecondsPerSecond = 1'000'000;
constexpr std::uint32_t kEnablingSteps = 4;  // fault reset, shutdown, switch on, enable operation

class Frames {
 public:
  explicit Frames(const Robot& robot) : robot_(robot) {}

  void cyclic(std::string name, std::uint32_t id, std::uint32_t data_bytes, std::uint8_t node,
              CyclePart part) {
    frames_.push_back({std::move(name), id, data_bytes, node, part, robot_.cycle_us, true, 0});
  }
  void on_change(std::string name, std::uint32_t id, std::uint32_t data_bytes, std::uint8_t node,
                 CyclePart part) {
    frames_.push_back(
        {std::move(name), id, data_bytes, node, part, robot_.cycle_us, false, kEnablingSteps});
  }
  void heartbeat(const std::string& of, std::uint8_t node, CyclePart part) {
    frames_.push_back({"heartbeat of " + of, tenon::canopen::kHeartbeat + node, 1, node, part,
                       robot_.heartbeat_ms * kMicrosecondsPerMillisecond, false, 0});
  }
  void add(const BusFrame& frame) { frames_.push_back(frame); }
  [[nodiscard]] std::vector<BusFrame> take() { return std::move(frames_); }

 private:
  const Robot& robot_;
  std::vector<BusFrame> frames_;
};

/// Targets two to a frame, controlwords beside them.
void add_packed_commands(const Robot& robot, Frames& frames) {
  const std::uint8_t master = robot.master_node;
  for (const Joint& joint : robot.joints) {
    frames.on_change("controlword of " + joint.name, joint_controlword_cob_id(joint.node), 2,
                     master, CyclePart::kCommand);
  }
  for (std::size_t i = 0; i < robot.joints.size(); i += 2) {
    const Joint& first = robot.joints[i];
    const bool pair = i + 1 < robot.joints.size();
    frames.cyclic(pair ? "targets of " + first.name + ", " + robot.joints[i + 1].name
                       : "target of " + first.name,
                  joint_command_cob_id(first.node), pair ? 8 : 4, master, CyclePart::kCommand);
  }
}

}  // namespace

std::vector<BusFrame> sensor_frames(const Robot& robot) {
  constexpr std::uint32_t kFull = 8;
  const ForceTorqueSensor& sensor = robot.sensor;
  if (sensor.absent()) return {};
  if (sensor.protocol == SensorProtocol::kNode) {
    const auto feedback = CyclePart::kFeedback;
    return {{"force", kForceCobId, kFull, sensor.node, feedback, robot.cycle_us},
            {"torque", kTorqueCobId, kFull, sensor.node, feedback, robot.cycle_us}};
  }
  if (sensor.protocol == SensorProtocol::kAtiNetcanoem) {
    constexpr std::uint32_t kSecondBytes = 6;
    const auto feedback = CyclePart::kFeedback;
    BusFrame request{"request of the sensor", sensor.request_id, 0,
                     robot.master_node,       feedback,          robot.cycle_us};
    request.bus = sensor.bus();
    return {std::move(request),
            {"gauges 0 2 4", sensor.sample_ids[0], kFull, 0, feedback, robot.cycle_us},
            {"gauges 1 3 5", sensor.sample_ids[1], kSecondBytes, 0, feedback, robot.cycle_us}};
  }
  // By its own clock, in any part of a cycle.
  const auto period_us =
      static_cast<std::uint32_t>(kMicrosecondsPerSecond / std::uint32_t(sensor.rate_hz));
  return {{"force", sensor.sample_ids[0], kFull, 0, CyclePart::kAnytime, period_us},
          {"torque", sensor.sample_ids[1], kFull, 0, CyclePart::kAnytime, period_us}};
}

std::vector<BusFrame> with_own_bus(std::vector<BusFrame> frames, const Robot& robot) {
  const ForceTorqueSensor& sensor = robot.sensor;
  if (!sensor.has_own_bus()) return frames;
  std::vector<BusFrame> twice;
  for (BusFrame& frame : frames) {
    const bool to_all = frame.id == tenon::canopen::kSync ||
                        frame.id == tenon::canopen::kHeartbeat + robot.master_node;
    if (frame.node == sensor.node) {
      frame.bus = kSensorBus;
    } else if (sensor.node != 0 && to_all) {
      twice.push_back(frame);
      twice.back().bus = kSensorBus;
    }
  }
  frames.insert(frames.end(), twice.begin(), twice.end());
  return frames;
}

std::vector<BusFrame> frame_set(const Robot& robot) {
  Frames frames(robot);
  frames.cyclic("SYNC", tenon::canopen::kSync, 0, robot.master_node, CyclePart::kSync);
  for (const BusFrame& frame : sensor_frames(robot)) frames.add(frame);
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    frames.cyclic("feedback of " + joint.name, joint_feedback_cob_id(robot, i), 8, joint.node,
                  CyclePart::kFeedback);
  }
  if (robot.targets_per_frame == 2) {
    add_packed_commands(robot, frames);
  } else {
    for (const Joint& joint : robot.joints) {
      frames.cyclic("command of " + joint.name, joint_command_cob_id(joint.node), 6,
                    robot.master_node, CyclePart::kCommand);
    }
  }
  for (const Joint& joint : robot.joints) {
    frames.heartbeat(joint.name, joint.node, CyclePart::kAnytime);
  }
  if (robot.sensor.node != 0) {
    frames.heartbeat("the sensor", robot.sensor.node, CyclePart::kAnytime);
  }
  frames.heartbeat("the master", robot.master_node, CyclePart::kCommand);
  return with_own_bus(frames.take(), robot);
}

}  // namespace tenon::hw
