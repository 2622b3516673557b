#pragma once
// Frames by which another master betrays itself. What this one sends it does not receive, so it
// must never hear SYNC, an NMT command, its own heartbeat, setpoints of its drives, or the start of
// an SDO download to one of its nodes. Uploads are welcome: somebody may read along. Real-time,
// pure after construction.

#include <array>
#include <bitset>
#include <cstdint>

#include "shared/cell/robot.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

class OtherMaster {
 public:
  explicit OtherMaster(const Robot& robot);

  [[nodiscard]] bool sent(const CanFrame& frame) const noexcept;

 private:
  static constexpr std::size_t kIdentifiers = 2048;
  /// Of one bus: what means a command there may be an answer on the other.
  struct Betrayals {
    std::bitset<kIdentifiers> masters_own;
    std::bitset<kIdentifiers> sdo_requests;
    std::uint32_t polled_id = kIdentifiers;  ///< an empty frame asks the sensor for a sample
  };
  std::array<Betrayals, 2> of_bus_;  ///< kArmBus, kSensorBus
};

}  // namespace tenon::hw
