#pragma once
// CRC-32 as Ethernet and zlib have it: reflected polynomial 0xEDB88320, initial value and final XOR
// all ones. Of bytes that come piece by piece.

#include <cstdint>
#include <span>

namespace tenon {

class Crc32 {
 public:
  void add(std::span<const std::uint8_t> bytes);
  /// Of all bytes so far. Check value: "123456789" gives 0xCBF43926.
  [[nodiscard]] std::uint32_t value() const { return ~remainder_; }

 private:
  std::uint32_t remainder_ = 0xFFFFFFFF;
};

}  // namespace tenon
