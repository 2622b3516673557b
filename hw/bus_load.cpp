#include "hw/bus_load.h"

#include <cmath>
#include <cstdio>

#include "shared/base/error.h"

namespace tenon::hw {

BusLoad bus_load(const Robot& robot) {
  BusLoad load;
  const auto add = [&load](std::uint32_t count, std::uint32_t data_bytes) {
    load.frames_per_cycle += count;
    load.nominal_bits += count * nominal_frame_bits(data_bytes);
    load.worst_bits += count * worst_frame_bits(data_bytes);
  };
  const auto joints = static_cast<std::uint32_t>(robot.joints.size());
  add(1, 0);
  add(joints, 6);
  add(joints, 8);
  add(2, 8);
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
  char text[256];
  std::snprintf(text, sizeof(text),
                "%u frames every %u us load a bus of %u bit/s with %.1f %% (%.1f %% in the worst "
                "case of stuffing), allowed are %.0f %%; take a cycle of at least %.0f us",
                load.frames_per_cycle, robot.cycle_us, robot.bitrate_bps, 100.0 * load.nominal,
                100.0 * load.worst, 100.0 * BusLoad::kWorstAllowed,
                std::ceil(fitting_us / 1000.0) * 1000.0);
  throw InputError("robot '" + robot.name + "': " + text);
}

}  // namespace tenon::hw
