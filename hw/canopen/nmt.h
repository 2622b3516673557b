#pragma once
// Network management commands (CiA 301, 7.2.8). Pure functions, real-time.
//
//   COB-ID 000h
//   | byte | meaning                                                                        |
//   |    0 | 01 start, 02 stop, 80h pre-operational, 81h reset node, 82h reset communication |
//   |    1 | node, 0 is all                                                                 |

#include <cstdint>

#include "shared/canopen/constants.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw::canopen {

/// @param command one of tenon::canopen::kNmt...  @param node 1..127, 0 for all
[[nodiscard]] constexpr CanFrame nmt_frame(std::uint8_t command, std::uint8_t node) {
  CanFrame frame;
  frame.id = tenon::canopen::kNmt;
  frame.length = 2;
  frame.data = {command, node};
  return frame;
}

}  // namespace tenon::hw::canopen
