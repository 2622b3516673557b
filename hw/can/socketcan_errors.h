#pragma once
// What an error frame of SocketCAN says of the bus (linux/can/error.h). Pure, real-time.

#include <array>
#include <cstdint>

#include "shared/ports/can_bus.h"

namespace tenon::hw {

/// @param error_class the frame's identifier without CAN_ERR_FLAG  @param data its 8 bytes
void apply_error_frame(std::uint32_t error_class, const std::array<std::uint8_t, 8>& data,
                       CanBusStatus& status) noexcept;

}  // namespace tenon::hw
