// Checksum, bytes and ring.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "shared/base/bytes.h"
#include "shared/base/crc32.h"
#include "shared/base/crc32c.h"
#include "shared/base/shown.h"
#include "shared/base/spsc_ring.h"
#include "shared/base/text.h"

namespace tenon {
namespace {

std::vector<std::uint8_t> bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

TEST(Text, AFormatIsAsLongAsItGets) {
  EXPECT_EQ(format("%s: %+.2f mm, %zu of %d", "gap", -0.125, std::size_t{3}, 7),
            "gap: -0.12 mm, 3 of 7");
  EXPECT_EQ(format("%s", std::string(10'000, 'x').c_str()).size(), 10'000U);
  EXPECT_EQ(format("%s", ""), "");
  EXPECT_EQ(format("100 %%"), "100 %");
}

TEST(Shown, LengthsAreMillimetresAndAnglesDegrees) {
  EXPECT_DOUBLE_EQ(shown(0.002, 2), 2.0);
  EXPECT_DOUBLE_EQ(shown(0.5 * 3.14159265358979323846, 3), 90.0);
  EXPECT_DOUBLE_EQ(degrees(-3.14159265358979323846), -180.0);
}

TEST(Text, AShellReadsAWordAsItWas) {
  EXPECT_EQ(shell_word("hw/cells/gantry3.yaml"), "hw/cells/gantry3.yaml");
  EXPECT_EQ(shell_word("task.yaml#tight"), "'task.yaml#tight'");
  EXPECT_EQ(shell_word("my plans/it's.tnp"), "'my plans/it'\\''s.tnp'");
  EXPECT_EQ(shell_word(""), "''");
}

// The definition, bit by bit.
std::uint32_t bitwise_crc32c(const std::vector<std::uint8_t>& bytes) {
  std::uint32_t remainder = 0xFFFFFFFF;
  for (const std::uint8_t byte : bytes) {
    for (int bit = 0; bit < 8; ++bit) {
      const bool carry = ((remainder ^ (byte >> bit)) & 1U) != 0;
      remainder = (remainder >> 1) ^ (carry ? 0x82F63B78 : 0U);
    }
  }
  return ~remainder;
}

// RFC 3720, B.4, and the check value of the usual catalogues.
TEST(Crc32c, GivesThePublishedCheckValues) {
  EXPECT_EQ(crc32c({}), 0U);
  EXPECT_EQ(crc32c(bytes_of("123456789")), 0xE3069283);
  EXPECT_EQ(crc32c(std::vector<std::uint8_t>(32, 0x00)), 0x8A9136AA);
  EXPECT_EQ(crc32c(std::vector<std::uint8_t>(32, 0xFF)), 0x62A8AB43);
  std::vector<std::uint8_t> rising(32);
  for (std::size_t i = 0; i < rising.size(); ++i) rising[i] = static_cast<std::uint8_t>(i);
  EXPECT_EQ(crc32c(rising), 0x46DD794E);
}

TEST(Crc32c, TableAgreesWithTheBitwiseDefinition) {
  std::vector<std::uint8_t> bytes;
  for (unsigned i = 0; i < 600; ++i) {
    EXPECT_EQ(crc32c(bytes), bitwise_crc32c(bytes)) << i << " bytes";
    bytes.push_back(static_cast<std::uint8_t>(i * 167 + 13));
  }
}

TEST(Crc32, HasTheCheckValueAndTakesItsBytesInPieces) {
  Crc32 crc;
  EXPECT_EQ(crc.value(), 0U);
  crc.add(bytes_of("1234"));
  crc.add(bytes_of("56789"));
  EXPECT_EQ(crc.value(), 0xCBF43926U);
}

TEST(Bytes, LittleEndianWhateverTheType) {
  std::array<std::uint8_t, 8> buffer{};
  store_le<std::uint32_t>(buffer, 0x11223344);
  EXPECT_EQ(buffer, (std::array<std::uint8_t, 8>{0x44, 0x33, 0x22, 0x11, 0, 0, 0, 0}));
  store_le<std::int16_t>(buffer, -2);
  EXPECT_EQ(buffer[0], 0xFE);
  EXPECT_EQ(buffer[1], 0xFF);
  EXPECT_EQ(load_le<std::int16_t>(buffer), -2);
  store_le(buffer, 1.0);
  EXPECT_EQ(buffer, (std::array<std::uint8_t, 8>{0, 0, 0, 0, 0, 0, 0xF0, 0x3F}));
  EXPECT_EQ(load_le<double>(buffer), 1.0);
  store_le(buffer, -2.5F);
  EXPECT_EQ(load_le<std::uint32_t>(buffer), 0xC0200000);
  store_le<std::uint64_t>(buffer, 0xFEDCBA9876543210);
  EXPECT_EQ(buffer[7], 0xFE);
  EXPECT_EQ(load_le<std::uint64_t>(buffer), 0xFEDCBA9876543210);
}

TEST(Bytes, ReaderStopsAtTheEndAndStaysStopped) {
  const std::array<std::uint8_t, 5> bytes = {1, 2, 3, 4, 5};
  ByteReader reader(bytes);
  EXPECT_EQ(reader.read<std::uint16_t>(), 0x0201);
  EXPECT_EQ(reader.read<std::uint32_t>(), 0U);  // three are left
  EXPECT_FALSE(reader.ok());
  EXPECT_EQ(reader.read<std::uint8_t>(), 0U);
  EXPECT_EQ(reader.offset(), 2U);
}

TEST(Bytes, WriterNeverPassesTheEnd) {
  std::array<std::uint8_t, 4> bytes = {9, 9, 9, 9};
  ByteWriter writer{std::span(bytes).first(3)};
  writer.write(std::uint16_t{0x0201});
  writer.write(std::uint16_t{0x0403});
  EXPECT_FALSE(writer.ok());
  writer.write(std::uint8_t{7});
  EXPECT_EQ(bytes, (std::array<std::uint8_t, 4>{1, 2, 9, 9}));
}

TEST(SpscRing, GivesElementsInOrderAndDropsWhenFull) {
  SpscRing<int, 4> ring;
  int element = -1;
  EXPECT_FALSE(ring.pop(element));
  EXPECT_EQ(element, -1);
  for (int round = 0; round < 3; ++round) {  // over the ring's seam
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.push(10 * round + i));
    EXPECT_FALSE(ring.push(99));
    for (int i = 0; i < 4; ++i) {
      ASSERT_TRUE(ring.pop(element));
      EXPECT_EQ(element, 10 * round + i);
    }
    EXPECT_FALSE(ring.pop(element));
  }
  EXPECT_EQ(ring.dropped(), 3U);
}

}  // namespace
}  // namespace tenon
