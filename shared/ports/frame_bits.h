#pragma once
// How long a classic CAN frame is on its bus, inter-frame space included. Real-time.

#include <cstdint>

#include "shared/ports/can_bus.h"

namespace tenon {

/// Of an 11-bit identifier (Davis et al. 2007, section 2), without stuff bits. @param data_bytes
/// 0..8
[[nodiscard]] constexpr std::uint32_t nominal_frame_bits(std::uint32_t data_bytes) {
  return 47 + 8 * data_bytes;
}
/// With all stuff bits that there can be.
[[nodiscard]] constexpr std::uint32_t worst_frame_bits(std::uint32_t data_bytes) {
  return nominal_frame_bits(data_bytes) + (34 + 8 * data_bytes - 1) / 4;
}

/// A 29-bit identifier takes 20 bits more, which can be stuffed too. A remote frame has no data.
[[nodiscard]] constexpr std::uint32_t nominal_frame_bits(const CanFrame& frame) {
  const std::uint32_t data_bytes = frame.remote ? 0 : frame.length;
  return nominal_frame_bits(data_bytes) + (frame.extended ? 20 : 0);
}
[[nodiscard]] constexpr std::uint32_t worst_frame_bits(const CanFrame& frame) {
  const std::uint32_t data_bytes = frame.remote ? 0 : frame.length;
  const std::uint32_t stuffable = (frame.extended ? 54 : 34) + 8 * data_bytes;
  return nominal_frame_bits(frame) + (stuffable - 1) / 4;
}

}  // namespace tenon
