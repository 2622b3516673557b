#pragma once
// The table of a reflected CRC of 32 bits.

#include <array>
#include <cstdint>

namespace tenon {

/// Entry b: the remainder of the byte b followed by 32 zero bits.
constexpr std::array<std::uint32_t, 256> crc_table(std::uint32_t polynomial) {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < table.size(); ++byte) {
    std::uint32_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder >> 1) ^ ((remainder & 1U) != 0 ? polynomial : 0U);
    }
    table[byte] = remainder;
  }
  return table;
}

/// The remainder with one byte more. Start from all ones, and turn all bits over at the end.
[[nodiscard]] constexpr std::uint32_t crc_step(const std::array<std::uint32_t, 256>& table,
                                               std::uint32_t remainder, std::uint8_t byte) {
  return (remainder >> 8) ^ table[(remainder ^ byte) & 0xFFU];
}

}  // namespace tenon
