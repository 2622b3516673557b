#include "shared/base/crc32.h"

#include "shared/base/crc_table.h"

namespace tenon {

void Crc32::add(std::span<const std::uint8_t> bytes) {
  constexpr std::uint32_t kPolynomial = 0xEDB88320;
  static constexpr std::array<std::uint32_t, 256> kTable = crc_table(kPolynomial);
  for (const std::uint8_t byte : bytes) remainder_ = crc_step(kTable, remainder_, byte);
}

}  // namespace tenon
