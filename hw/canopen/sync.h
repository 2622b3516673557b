#pragma once
// The SYNC object (CiA 301, 7.2.5): COB-ID 080h, no data. Synchronous RPDOs received before it act
// on it, synchronous TPDOs answer it. Pure, real-time.

#include "shared/canopen/constants.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw::canopen {

[[nodiscard]] constexpr CanFrame sync_frame() {
  CanFrame frame;
  frame.id = tenon::canopen::kSync;
  return frame;
}

}  // namespace tenon::hw::canopen
