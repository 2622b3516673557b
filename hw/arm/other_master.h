#pragma once
// Frames by which another master betrays itself. What this one sends it does not receive, so it
// must never hear SYNC, an NMT command, its own heartbeat, setpoints of its drives, or the start of
// an SDO download to one of its nodes. Uploads are welcome: somebody may read along. Real-time,
// pure after construction.

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
  std::bitset<kIdentifiers> masters_own_;
  std::bitset<kIdentifiers> sdo_requests_;
  std::uint32_t polled_id_ = kIdentifiers;  ///< an empty frame asks the sensor for a sample
};

}  // namespace tenon::hw
