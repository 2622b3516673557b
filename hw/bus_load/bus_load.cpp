#include "hw/bus_load/bus_load.h"

#include <algorithm>
#include <cmath>

#include "hw/mit/motor_frame_set.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/mit/robot_motors.h"

namespace tenon::hw {

std::vector<BusFrame> arm_frames(const Robot& robot) {
  return speaks_mit(robot) ? mit::motor_frame_set(robot) : frame_set(robot);
}

std::uint32_t master_frames(const Robot& robot) {
  const std::vector<BusFrame> frames = arm_frames(robot);
  return static_cast<std::uint32_t>(
      std::count_if(frames.begin(), frames.end(),
                    [&](const BusFrame& frame) { return frame.node == robot.master_node; }));
}

BusLoad bus_load(const Robot& robot) {
  BusLoad load;
  for (const BusFrame& frame : arm_frames(robot)) {
    if (!frame.every_cycle) continue;
    ++load.frames_per_cycle;
    load.nominal_bits += nominal_frame_bits(frame.data_bytes);
    load.worst_bits += worst_frame_bits(frame.data_bytes);
  }
  const double bits_per_cycle =
      static_cast<double>(robot.bitrate_bps) * static_cast<double>(robot.cycle_us) * 1e-6;
  load.nominal = load.nominal_bits / bits_per_cycle;
  load.worst = load.worst_bits / bits_per_cycle;
  return load;
}

void check_bus_load(const Robot& robot) {
  const BusLoad load = bus_load(robot);
  if (load.worst <= BusLoad::kWorstAllowed) {
    return;
  }
  const double fitting_us =
      load.worst_bits / (BusLoad::kWorstAllowed * static_cast<double>(robot.bitrate_bps)) * 1e6;
  Robot packed = robot;
  packed.targets_per_frame = 2;
  const bool packing_helps = bus_load(packed).worst <= BusLoad::kWorstAllowed;
  throw InputError(
      "robot '" + robot.name + "': " +
      format("%u frames every %u us load a bus of %u bit/s with %.1f %% (%.1f %% in the worst case "
             "of stuffing), allowed are %.0f %%; take %sa cycle of at least %.0f us",
             load.frames_per_cycle, robot.cycle_us, robot.bitrate_bps, 100.0 * load.nominal,
             100.0 * load.worst, 100.0 * BusLoad::kWorstAllowed,
             packing_helps ? "targets_per_frame: 2 or " : "",
             std::ceil(fitting_us / 1000.0) * 1000.0));
}

}  // namespace tenon::hw
