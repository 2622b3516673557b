#pragma once
// How much of the bus an arm's cycle takes, before anything is connected. Pure, set-up code.

#include <cstdint>
#include <string>
#include <vector>

#include "hw/arm/frame_set.h"
#include "shared/cell/robot.h"
#include "shared/ports/frame_bits.h"

namespace tenon::hw {

struct BusLoad {
  std::uint32_t frames_per_cycle = 0;
  std::uint32_t nominal_bits = 0;  ///< a cycle, without stuff bits
  std::uint32_t worst_bits = 0;    ///< a cycle, with all that can be
  double nominal = 0.0;            ///< fraction of the bus
  double worst = 0.0;

  /// What remains is for heartbeats, EMCY and SDO.
  static constexpr double kWorstAllowed = 0.85;
};

/// The buses that an arm is on: its own, and the sensor's where that has one to itself.
[[nodiscard]] std::vector<std::uint8_t> buses_of(const Robot& robot);

/// "bus", or "the arm's bus" and "the sensor's bus" where there are two.
[[nodiscard]] std::string bus_title(const Robot& robot, std::uint8_t bus);

[[nodiscard]] std::uint32_t bitrate_bps(const Robot& robot, std::uint8_t bus);

/// The frames of an arm on one bus, whatever its drives speak.
[[nodiscard]] std::vector<BusFrame> arm_frames(const Robot& robot, std::uint8_t bus = kArmBus);

/// The most that the master sends in one cycle: what its transmit queue must hold.
[[nodiscard]] std::uint32_t master_frames(const Robot& robot, std::uint8_t bus = kArmBus);

/// Of CiA 402 drives SYNC, one 6-byte RPDO (or half an 8-byte one, packed) and one 8-byte TPDO a
/// joint, two 8-byte force/torque frames. The controlwords of packed targets are sent on change and
/// not counted. Of motors in MIT mode SYNC, an 8-byte command and an 8-byte answer a joint, and the
/// two of force/torque.
[[nodiscard]] BusLoad bus_load(const Robot& robot, std::uint8_t bus = kArmBus);

/// A line for people, for each bus.
[[nodiscard]] std::string describe_loads(const Robot& robot);

/// Throws InputError with the numbers where the worst case of a bus exceeds kWorstAllowed.
void check_bus_load(const Robot& robot);

}  // namespace tenon::hw
