#pragma once
// How much of the bus an arm's cycle takes, before anything is connected. Pure, set-up code.
//
// A classic CAN frame with an 11-bit identifier and n data bytes has 47 + 8n bits, inter-frame
// space included; the worst stuffing adds floor((34 + 8n - 1) / 4) (Davis et al. 2007, section 2).

#include <cstdint>
#include <vector>

#include "hw/arm/frame_set.h"
#include "shared/cell/robot.h"

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

/// @param data_bytes 0..8
[[nodiscard]] constexpr std::uint32_t nominal_frame_bits(std::uint32_t data_bytes) {
  return 47 + 8 * data_bytes;
}
[[nodiscard]] constexpr std::uint32_t worst_frame_bits(std::uint32_t data_bytes) {
  return nominal_frame_bits(data_bytes) + (34 + 8 * data_bytes - 1) / 4;
}

/// The frames of an arm, whatever its drives speak.
[[nodiscard]] std::vector<BusFrame> arm_frames(const Robot& robot);

/// The most that the master sends in one cycle: what its transmit queue must hold.
[[nodiscard]] std::uint32_t master_frames(const Robot& robot);

/// Of CiA 402 drives SYNC, one 6-byte RPDO (or half an 8-byte one, packed) and one 8-byte TPDO a
/// joint, two 8-byte force/torque frames. The controlwords of packed targets are sent on change and
/// not counted. Of motors in MIT mode SYNC, an 8-byte command and an 8-byte answer a joint, and the
/// two of force/torque.
[[nodiscard]] BusLoad bus_load(const Robot& robot);

/// Throws InputError with the numbers where the worst case exceeds kWorstAllowed.
void check_bus_load(const Robot& robot);

}  // namespace tenon::hw
