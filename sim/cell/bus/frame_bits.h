#pragma once
// How many bits a frame is on the wire, exactly: header, data, checksum, stuff bits (ISO 11898-1:
// 2015, 10.4 and 10.5). From start of frame to end of frame; the intermission follows.
//
// Classic frame: the checksum (CRC-15, polynomial 4599h) is computed, because its bits are stuffed
// as all others are: after five equal bits comes their complement, up to the last checksum bit.
//
//   | SOF | identifier, RTR, IDE, r | DLC | data | CRC | CRC del. | ACK, ACK del. | EOF |
//   |  1  | 14 (29-bit id: 34)      |  4  |  8n  | 15  |    1     |       2       |  7  |
//
// FD frame: stuffing ends with the data. Then come the stuff count (4 bits) and CRC-17 (up to 16
// bytes) or CRC-21 with a fixed stuff bit before the first bit and after every fourth, so the
// checksum's value does not matter. The fixed bit takes the place of a stuff bit that the data's
// last bits would call for.
//
// Pure; any thread; no allocation.

#include <cstdint>
#include <span>

#include "shared/ports/can_bus.h"

namespace tenon::sim {

/// Between two frames, or after an error frame.
inline constexpr std::uint32_t kIntermissionBits = 3;
/// What ends a frame: CRC delimiter, ACK slot and delimiter, end of frame.
inline constexpr std::uint32_t kTailBits = 10;

struct FrameBits {
  std::uint32_t nominal = 0;  ///< at the bit rate of arbitration
  std::uint32_t data = 0;     ///< at the bit rate of the data phase; 0 in classic frames

  friend bool operator==(const FrameBits&, const FrameBits&) = default;
};

/// Cost: about 0.2 us.
[[nodiscard]] FrameBits classic_frame_bits(const CanFrame& frame);

/// @param data of a length that FD frames have: 0..8, 12, 16, 20, 24, 32, 48, 64
/// @param switch_rate BRS: from ESI to the last checksum bit, the bits are those of the data phase.
/// The two bits within which the rate changes (BRS, CRC delimiter) count as nominal.
[[nodiscard]] FrameBits fd_frame_bits(std::uint32_t id, bool extended,
                                      std::span<const std::uint8_t> data, bool switch_rate);

/// The data length code of an FD frame; -1 where there is none for this length.
[[nodiscard]] int fd_length_code(std::size_t data_bytes);

}  // namespace tenon::sim
