// What is decoded of force/torque sensors that are no CANopen nodes: frames in any order, of any
// content, at any time, through their sources, the one judge of these, and their starts.
//
// Input: one byte (the sensor), then operations: a byte and its arguments.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hw/arm/describe_fault.h"
#include "hw/arm/sensor_device.h"
#include "hw/sensors/wrench_intake.h"
#include "tests/fuzz/support/must.h"
#include "tests/hw/gantry_on_bus.h"

namespace {

using namespace tenon;
using namespace tenon::hw;
using fuzz::must;

ForceTorqueSensor sensor_of(unsigned which) {
  ForceTorqueSensor sensor;
  sensor.force_per_count_N = 0.02;
  sensor.torque_per_count_Nm = 0.0005;
  sensor.force_range_N = 200.0;
  sensor.torque_range_Nm = 4.0;
  sensor.cycles_per_sample = 3;
  if (which % 3 == 1) {
    sensor.protocol = SensorProtocol::kAtiNetcanoem;
    sensor.request_id = 0x170;
    sensor.sample_ids = {0x170, 0x171};
  }
  if (which % 3 == 0) {
    sensor.protocol = SensorProtocol::kRobotousRft;
    sensor.request_id = 0x64;
    sensor.sample_ids = {0x01, 0x02};
    sensor.rate_hz = 200;
  }
  return sensor;
}

class NoBus final : public CanBus {
 public:
  SendResult send(const CanFrame& frame) noexcept override {
    must(frame.length <= 8 && frame.id <= 0x7FF && !frame.extended && !frame.remote,
         "a sensor is asked by data frames of 11 bits");
    return SendResult::kSent;
  }
  bool receive(ReceivedFrame& /*received*/) noexcept override { return false; }
  void flush() noexcept override {}
  void wait(std::int64_t /*at_most_ns*/) noexcept override {}
  [[nodiscard]] CanBusStatus status() const noexcept override { return {}; }
};

/// A frame on one of the identifiers, of 8 bytes unless the operation says otherwise.
CanFrame frame_of(std::uint8_t operation, std::span<const std::uint8_t> bytes,
                  const ForceTorqueSensor& sensor) {
  CanFrame frame;
  frame.id = (operation & 1U) != 0 ? sensor.sample_ids[1] : sensor.sample_ids[0];
  // Its other operations' answers.
  if (sensor.protocol == SensorProtocol::kAtiNetcanoem && (operation & 0x80U) != 0) {
    frame.id = sensor.request_id | (operation >> 3U & 0xFU);
  }
  frame.length = (operation & 2U) != 0 ? static_cast<std::uint8_t>(operation >> 4U & 7U) : 8;
  frame.extended = (operation & 0x84U) == 0x84U;
  for (std::size_t i = 0; i < bytes.size(); ++i) frame.data[i] = bytes[i];
  return frame;
}

void check(const WrenchIntake& intake) {
  if (intake.sample()) must(intake.sample()->wrench.allFinite(), "a sample is finite");
  if (intake.force_N()) must(intake.force_N()->allFinite(), "a force is finite");
  if (intake.saturated()) must(intake.saturated()->place < 6, "a place of the wrench");
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> input(data, size);
  if (input.empty()) return 0;
  Robot robot = gantry_robot();
  robot.sensor = sensor_of(input[0]);
  const SensorDevice device = open_sensor(robot.sensor);
  WrenchIntake intake(*device.source, robot.sensor);
  NoBus bus;
  std::int64_t now_ns = 0;
  for (std::size_t at = 1; at + 9 <= input.size(); at += 9) {
    const std::uint8_t operation = input[at];
    now_ns += std::int64_t{operation & 0x78U} * 100'000;
    const CanFrame frame = frame_of(operation, input.subspan(at + 1, 8), robot.sensor);
    if (device.start != nullptr) {
      device.start->process(frame);
      device.start->update(now_ns, bus);
      if (device.failed()) {
        must(!describe(device.start->fault(), robot).empty(), "a fault has a line");
        device.start->restart();
      }
    }
    if ((operation & 4U) != 0) (void)intake.begin_cycle();
    const std::uint64_t torn = intake.torn();
    (void)intake.take(frame, now_ns);
    must(intake.torn() <= torn + 2, "a frame tears two halves at most");
    check(intake);
  }
  return 0;
}
