#pragma once
// Object values as people type and read them. Set-up code, pure; throws InputError with one line.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tenon::hw::canopen {

/// The little-endian bytes of a value.
/// @param type u8 u16 u32 i8 i16 i32 or str  @param value decimal, 0x.., or text for str
[[nodiscard]] std::vector<std::uint8_t> object_bytes(const std::string& type,
                                                     const std::string& value);

/// "0x00020192 = 131474 (4 bytes)", signed as well where the top bit is set; text where the bytes
/// are printable and more than four; hex bytes otherwise.
[[nodiscard]] std::string object_text(std::span<const std::uint8_t> bytes);

}  // namespace tenon::hw::canopen
