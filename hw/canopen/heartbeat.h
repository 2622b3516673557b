#pragma once
// Heartbeats (CiA 301, 7.2.8.3.2). Pure functions, real-time.
//
//   COB-ID 700h + node
//   | byte | meaning                                                       |
//   |    0 | bits 0-6: 00 boot-up, 04 stopped, 05 operational, 7Fh pre-op.; |
//   |      | bit 7 is the toggle of node guarding, 0 in a heartbeat        |
//
// An answer to node guarding, which somebody else may do, tells the state as a heartbeat does.

#include <cstdint>
#include <optional>

#include "shared/canopen/constants.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw::canopen {

struct Heartbeat {
  std::uint8_t node = 0;
  std::uint8_t state = 0;  ///< tenon::canopen::kState...

  friend bool operator==(const Heartbeat&, const Heartbeat&) = default;
};

[[nodiscard]] constexpr CanFrame heartbeat_frame(const Heartbeat& heartbeat) {
  CanFrame frame;
  frame.id = tenon::canopen::kHeartbeat + heartbeat.node;
  frame.length = 1;
  frame.data[0] = heartbeat.state;
  return frame;
}

/// Empty where the frame is no heartbeat.
[[nodiscard]] constexpr std::optional<Heartbeat> decode_heartbeat(const CanFrame& frame) {
  const std::uint32_t base = tenon::canopen::kHeartbeat;
  if (frame.extended || frame.remote || frame.length != 1 || frame.id <= base ||
      frame.id > base + 127) {
    return std::nullopt;
  }
  constexpr unsigned kStateMask = 0x7F;
  return Heartbeat{static_cast<std::uint8_t>(frame.id - base),
                   static_cast<std::uint8_t>(frame.data[0] & kStateMask)};
}

}  // namespace tenon::hw::canopen
