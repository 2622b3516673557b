#pragma once
// A CAN bus by its URI. Set-up code; throws InputError with one line.
//
//   socketcan:can0                  an interface of the kernel
//   slcan:/dev/ttyACM0              a serial adapter, or a pty
//   slcan://127.0.0.1:29536         slcan over TCP, as the virtual arm offers it
//   slcan-listen://127.0.0.1:29536  the virtual arm's end of that; port 0 takes a free one

#include <cstdint>
#include <memory>
#include <string>

#include "shared/ports/can_bus.h"

namespace tenon::hw {

/// @param bitrate_bps told to slcan adapters; a SocketCAN interface is set from outside and checked
/// @param burst_frames what a cycle sends at once; a SocketCAN transmit queue must hold it
[[nodiscard]] std::unique_ptr<CanBus> open_bus(const std::string& uri, std::uint32_t bitrate_bps,
                                               std::uint32_t burst_frames = 1);

/// The port of a slcan-listen bus, 0 for any other.
[[nodiscard]] std::uint16_t listening_port(const CanBus& bus);

}  // namespace tenon::hw
