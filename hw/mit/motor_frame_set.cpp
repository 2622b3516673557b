#include "hw/mit/motor_frame_set.h"

#include <cstdint>
#include <utility>

#include "shared/canopen/constants.h"
#include "shared/mit/robot_motors.h"

namespace tenon::hw::mit {

std::vector<BusFrame> motor_frame_set(const Robot& robot) {
  constexpr std::uint32_t kFull = 8;
  const std::uint8_t sensor = robot.sensor.node;
  const std::uint32_t cycle_us = robot.cycle_us;
  std::vector<BusFrame> frames = {
      {"SYNC", tenon::canopen::kSync, 0, robot.master_node, CyclePart::kSync, cycle_us}};
  for (const BusFrame& frame : sensor_frames(robot)) frames.push_back(frame);
  for (const Joint& joint : robot.joints) {
    frames.push_back({"command of " + joint.name, joint.node, kFull, robot.master_node,
                      CyclePart::kFeedback, cycle_us});
    frames.push_back({"feedback of " + joint.name, mit_motor(joint).feedback_id, kFull, joint.node,
                      CyclePart::kFeedback, cycle_us});
    // What stops leaves beside the cycle's own command, and is answered too.
    frames.push_back({"stop of " + joint.name, joint.node, kFull, robot.master_node,
                      CyclePart::kCommand, cycle_us, false, 1});
    frames.push_back({"answer to it of " + joint.name, mit_motor(joint).feedback_id, kFull,
                      joint.node, CyclePart::kCommand, cycle_us, false, 1});
  }
  const std::uint32_t heartbeat_us = 1000 * robot.heartbeat_ms;
  if (sensor != 0) {
    frames.push_back({"heartbeat of the sensor", tenon::canopen::kHeartbeat + sensor, 1, sensor,
                      CyclePart::kAnytime, heartbeat_us, false});
  }
  frames.push_back({"heartbeat of the master", tenon::canopen::kHeartbeat + robot.master_node, 1,
                    robot.master_node, CyclePart::kCommand, heartbeat_us, false});
  return with_own_bus(std::move(frames), robot);
}

}  // namespace tenon::hw::mit
