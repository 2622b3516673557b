#pragma once
// Which frames an arm has on its bus in operation: who sends what, how long, how often, and in
// which part of the cycle. What the load and the response times are computed from. Set-up code.

#include <cstdint>
#include <string>
#include <vector>

#include "shared/cell/robot.h"

namespace tenon::hw {

/// The parts of a cycle follow one another: feedback answers SYNC, and setpoints wait for feedback.
enum class CyclePart : std::uint8_t {
  kSync = 0,
  kFeedback = 1,
  kCommand = 2,
  kAnytime = 3,  ///< heartbeats of the devices
};

struct BusFrame {
  std::string name;  ///< for people: "feedback of arm_1"
  std::uint32_t id = 0;
  std::uint32_t data_bytes = 0;
  std::uint8_t node = 0;  ///< the sender
  CyclePart part = CyclePart::kSync;
  std::uint32_t period_us = 0;  ///< least time from one to the next
  bool every_cycle = true;      ///< false: heartbeats, controlwords that are sent on change
  std::uint32_t in_a_row = 0;   ///< then comes a pause of many cycles; 0: it never does
  std::uint8_t bus = kArmBus;
};

/// Of the force/torque sensor, but for its heartbeat. What is no CANopen node is sender 0.
[[nodiscard]] std::vector<BusFrame> sensor_frames(const Robot& robot);

/// Where the sensor has a bus to itself, what it sends and what the master sends to all is put
/// there.
[[nodiscard]] std::vector<BusFrame> with_own_bus(std::vector<BusFrame> frames, const Robot& robot);

[[nodiscard]] std::vector<BusFrame> frame_set(const Robot& robot);

}  // namespace tenon::hw
