#pragma once
// CRC-32C (Castagnoli): reflected polynomial 0x82F63B78, initial value and final XOR all ones.

#include <cstddef>
#include <cstdint>
#include <span>

namespace tenon {

/// Check value: "123456789" gives 0xE3069283.
[[nodiscard]] std::uint32_t crc32c(std::span<const std::uint8_t> bytes);

}  // namespace tenon
