#include "shared/base/crc32c.h"

#include "shared/base/crc_table.h"

namespace tenon {

std::uint32_t crc32c(std::span<const std::uint8_t> bytes) {
  constexpr std::uint32_t kPolynomial = 0x82F63B78;
  static constexpr std::array<std::uint32_t, 256> kTable = crc_table(kPolynomial);
  std::uint32_t remainder = 0xFFFFFFFF;
  for (const std::uint8_t byte : bytes) remainder = crc_step(kTable, remainder, byte);
  return ~remainder;
}

}  // namespace tenon
