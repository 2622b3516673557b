#include "hw/bus_load/bus_load.h"

#include <algorithm>
#include <cmath>

#include "hw/mit/motor_frame_set.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/mit/robot_motors.h"

namespace tenon::hw {

std::vector<std::uint8_t> buses_of(const Robot& robot) {
  if (robot.sensor.has_own_bus()) return {kArmBus, kSensorBus};
  return {kArmBus};
}

std::string bus_title(const Robot& robot, std::uint8_t bus) {
  if (!robot.sensor.has_own_bus()) return "bus";
  return bus == kSensorBus ? "the sensor's bus" : "the arm's bus";
}

std::uint32_t bitrate_bps(const Robot& robot, std::uint8_t bus) {
  return bus == kSensorBus ? robot.sensor.own_bitrate_bps : robot.bitrate_bps;
}

std::vector<BusFrame> arm_frames(const Robot& robot, std::uint8_t bus) {
  std::vector<BusFrame> frames = speaks_mit(robot) ? mit::motor_frame_set(robot) : frame_set(robot);
  std::erase_if(frames, [bus](const BusFrame& frame) { return frame.bus != bus; });
  return frames;
}

std::uint32_t master_frames(const Robot& robot, std::uint8_t bus) {
  const std::vector<BusFrame> frames = arm_frames(robot, bus);
  return static_cast<std::uint32_t>(
      std::count_if(frames.begin(), frames.end(),
                    [&](const BusFrame& frame) { return frame.node == robot.master_node; }));
}

BusLoad bus_load(const Robot& robot, std::uint8_t bus) {
  BusLoad load;
  for (const BusFrame& frame : arm_frames(robot, bus)) {
    if (!frame.every_cycle) continue;
    ++load.frames_per_cycle;
    load.nominal_bits += nominal_frame_bits(frame.data_bytes);
    load.worst_bits += worst_frame_bits(frame.data_bytes);
  }
  const double bits_per_cycle =
      static_cast<double>(bitrate_bps(robot, bus)) * static_cast<double>(robot.cycle_us) * 1e-6;
  load.nominal = load.nominal_bits / bits_per_cycle;
  load.worst = load.worst_bits / bits_per_cycle;
  return load;
}

std::string describe_loads(const Robot& robot) {
  std::string text;
  for (const std::uint8_t bus : buses_of(robot)) {
    const BusLoad load = bus_load(robot, bus);
    text += bus_title(robot, bus) +
            format(": %u frames every %u us, %.1f %% of %u bit/s (%.1f %% at worst)\n",
                   load.frames_per_cycle, robot.cycle_us, 100.0 * load.nominal,
                   bitrate_bps(robot, bus), 100.0 * load.worst);
  }
  return text;
}

namespace {

void check_bus_load(const Robot& robot, std::uint8_t bus) {
  const BusLoad load = bus_load(robot, bus);
  if (load.worst <= BusLoad::kWorstAllowed) {
    return;
  }
  const std::uint32_t rate_bps = bitrate_bps(robot, bus);
  const double fitting_us =
      load.worst_bits / (BusLoad::kWorstAllowed * static_cast<double>(rate_bps)) * 1e6;
  Robot packed = robot;
  packed.targets_per_frame = 2;
  const bool packing_helps =
      bus == kArmBus && bus_load(packed, bus).worst <= BusLoad::kWorstAllowed;
  throw InputError(
      "robot '" + robot.name +
      "': " + (robot.sensor.has_own_bus() ? bus_title(robot, bus) + ": " : "") +
      format("%u frames every %u us load a bus of %u bit/s with %.1f %% (%.1f %% in the worst case "
             "of stuffing), allowed are %.0f %%; take %sa cycle of at least %.0f us",
             load.frames_per_cycle, robot.cycle_us, rate_bps, 100.0 * load.nominal,
             100.0 * load.worst, 100.0 * BusLoad::kWorstAllowed,
             packing_helps ? "targets_per_frame: 2 or " : "",
             std::ceil(fitting_us / 1000.0) * 1000.0));
}

}  // namespace

void check_bus_load(const Robot& robot) {
  for (const std::uint8_t bus : buses_of(robot)) check_bus_load(robot, bus);
}

}  // namespace tenon::hw
