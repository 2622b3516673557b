// Lengths of frames against literal bit strings, and against an oracle that writes every bit of a
// frame from the standard's field tables, checksums by long division.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sim/cell/bus/frame_bits.h"

namespace tenon::sim {
namespace {

// --- the oracle: strings of '0' and '1' ----------------------------------------------------------

std::string binary(std::uint64_t value, std::size_t digits) {
  std::string text;
  for (std::size_t i = 0; i < digits; ++i) text.insert(text.begin(), (value >> i & 1) ? '1' : '0');
  return text;
}

/// The remainder of the message, followed by as many zeros as the polynomial has degrees; `preset`
/// is added to the first bits, which is what a register's start value does.
std::string remainder(std::string message, const std::string& polynomial,
                      const std::string& preset) {
  const std::size_t degree = polynomial.size() - 1;
  message.append(degree, '0');
  const auto add = [&](std::size_t at, const std::string& what) {
    for (std::size_t i = 0; i < what.size(); ++i) {
      if (what[i] == '1') message[at + i] = message[at + i] == '0' ? '1' : '0';
    }
  };
  add(0, preset);
  for (std::size_t i = 0; i + degree < message.size(); ++i) {
    if (message[i] == '1') add(i, polynomial);
  }
  return message.substr(message.size() - degree);
}

const std::string kCrc15 = "1" + binary(0x4599, 15);
const std::string kCrc17 = "1" + binary(0x1685B, 17);
const std::string kCrc21 = "1" + binary(0x102899, 21);

std::string stuffed(const std::string& bits) {
  std::string sent;
  for (const char bit : bits) {
    sent += bit;
    const std::size_t other = sent.find_last_not_of(bit);
    const std::size_t run = other == std::string::npos ? sent.size() : sent.size() - 1 - other;
    if (run == 5) sent += bit == '0' ? '1' : '0';
  }
  return sent;
}

std::string bytes(std::span<const std::uint8_t> data) {
  std::string text;
  for (const std::uint8_t byte : data) text += binary(byte, 8);
  return text;
}

const std::string kTail =
    "1"
    "01"
    "1111111";  // CRC delimiter, ACK, end of frame

std::string classic(const CanFrame& frame) {
  const std::string remote = frame.remote ? "1" : "0";
  std::string bits = "0";
  bits += frame.extended
              ? binary(frame.id >> 18, 11) + "11" + binary(frame.id & 0x3FFFF, 18) + remote + "00"
              : binary(frame.id, 11) + remote + "00";
  bits += binary(frame.length, 4);
  if (!frame.remote) bits += bytes(std::span(frame.data).first(frame.length));
  return stuffed(bits + remainder(bits, kCrc15, "")) + kTail;
}

/// The bits of an FD frame, and how many of them lie between BRS and CRC delimiter.
std::string fd(std::uint32_t id, bool extended, const std::vector<std::uint8_t>& data, bool brs,
               std::size_t& data_phase) {
  const std::size_t lengths[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
  std::size_t code = 0;
  while (lengths[code] != data.size()) ++code;
  const std::string arbitration =
      (extended ? "0" + binary(id >> 18, 11) + "11" + binary(id & 0x3FFFF, 18) + "0"
                : "0" + binary(id, 11) + "00") +
      "10" + (brs ? "1" : "0");
  const std::string bits = arbitration + "0" + binary(code, 4) + bytes(data);
  std::string sent = stuffed(bits);
  // A stuff bit after the very last data bit gives way to the first fixed stuff bit.
  if (stuffed(bits.substr(0, bits.size() - 1)).size() + 2 == sent.size()) sent.pop_back();

  const std::size_t stuff_bits = sent.size() - bits.size();
  const std::size_t gray = (stuff_bits % 8) ^ (stuff_bits % 8 >> 1);
  std::string count = binary(gray, 3);
  count += (count[0] ^ count[1] ^ count[2]) & 1 ? "1" : "0";
  const std::string& polynomial = data.size() <= 16 ? kCrc17 : kCrc21;
  const std::string checked = count + remainder(sent + count, polynomial, "1");
  for (std::size_t i = 0; i < checked.size(); ++i) {
    if (i % 4 == 0) sent += sent.back() == '0' ? '1' : '0';
    sent += checked[i];
  }
  std::string before = stuffed(arbitration);
  if (stuffed(arbitration.substr(0, arbitration.size() - 1)).size() + 2 == before.size()) {
    before.pop_back();
  }
  data_phase = sent.size() - before.size();
  return sent + kTail;
}

TEST(FrameBitsOracle, ChecksumsGiveTheCheckValuesOfTheCrcCatalogue) {
  const std::string digits = "123456789";
  std::string message;
  for (const char digit : digits) message += binary(static_cast<std::uint8_t>(digit), 8);
  EXPECT_EQ(remainder(message, kCrc15, ""), binary(0x059E, 15));
  EXPECT_EQ(remainder(message, kCrc17, ""), binary(0x04F03, 17));
  EXPECT_EQ(remainder(message, kCrc21, ""), binary(0x0ED841, 21));
}

// --- literal frames ------------------------------------------------------------------------------

/// Of a literal up to the checksum's end, in which brackets stand around stuff bits and spaces
/// between fields.
std::uint32_t length_of(const std::string& literal) {
  const auto bits = std::count_if(literal.begin(), literal.end(),
                                  [](char bit) { return bit == '0' || bit == '1'; });
  return static_cast<std::uint32_t>(bits) + 10;
}

TEST(FrameBits, LiteralFramesAreAsLongAsTheyStandHere) {
  const std::pair<CanFrame, std::string> frames[] = {
      // SYNC
      {{0x080, false, false, 0, {}}, "0 000100000[1]00 000[1] 0000 0[1]011100000[1]00101"},
      // heartbeat of node 127, operational
      {{0x77F, false, false, 1, {0x05}},
       "0 111011111[0]11 000 00[1]01 00000[1]101 1100000[1]01101000"},
      // 201#0F0000000000, long runs of zeros
      {{0x201, false, false, 6, {0x0F}},
       "0 0100000[1]0001 000 0110 0000[1]1111[0] 0000[1]0000 0[1]00000[1]00 000[1]00000[1] "
       "00000[1]000 00[1]00000[1]0 001010101110110"},
      // no run of five but in the checksum
      {{0x555, false, false, 8, {0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55}},
       "0 10101010101 000 1000 01010101 01010101 01010101 01010101 01010101 01010101 01010101 "
       "01010101 001101100000[1]100"},
  };
  for (const auto& [frame, literal] : frames) {
    EXPECT_EQ(classic_frame_bits(frame).nominal, length_of(literal)) << literal;
  }
}

TEST(FrameBits, TheMostStuffBitsThatAFrameCanHaveAreNeverExceeded) {
  // 0 followed by 1111 0000 1111 ...: each stuff bit begins the next run.
  std::mt19937_64 random(7);
  for (int i = 0; i < 20'000; ++i) {
    CanFrame frame{static_cast<std::uint32_t>(random() & 0x7FF),
                   false,
                   false,
                   static_cast<std::uint8_t>(random() % 9),
                   {}};
    for (auto& byte : frame.data) byte = (random() & 1) ? 0x0F : 0x3C;
    const std::uint32_t plain = 44 + 8u * frame.length;
    const std::uint32_t bits = classic_frame_bits(frame).nominal;
    EXPECT_GE(bits, plain);
    EXPECT_LE(bits, plain + (34 + 8u * frame.length - 1) / 4);
  }
}

TEST(FrameBits, ClassicFramesAreAsLongAsTheOracleWritesThem) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20'000; ++i) {
    CanFrame frame;
    frame.extended = (random() & 1) != 0;
    frame.remote = random() % 8 == 0;
    frame.id = static_cast<std::uint32_t>(random()) & (frame.extended ? 0x1FFFFFFFu : 0x7FFu);
    if (random() % 4 == 0) frame.id &= 0x3F;  // long runs
    frame.length = static_cast<std::uint8_t>(random() % 9);
    const std::uint64_t pattern = random();
    for (auto& byte : frame.data) {
      byte = pattern % 3 == 0 ? 0 : pattern % 3 == 1 ? 0xFF : static_cast<std::uint8_t>(random());
    }
    const FrameBits bits = classic_frame_bits(frame);
    ASSERT_EQ(bits, (FrameBits{static_cast<std::uint32_t>(classic(frame).size()), 0})) << i;
  }
}

TEST(FrameBits, FdFramesAreAsLongAsTheOracleWritesThem) {
  std::mt19937_64 random(2);
  const std::size_t lengths[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
  for (int i = 0; i < 20'000; ++i) {
    const bool extended = (random() & 1) != 0;
    const bool brs = (random() & 1) != 0;
    auto id = static_cast<std::uint32_t>(random()) & (extended ? 0x1FFFFFFFu : 0x7FFu);
    if (random() % 4 == 0) id &= 0x7u;
    std::vector<std::uint8_t> data(lengths[random() % 16]);
    const std::uint64_t pattern = random();
    for (auto& byte : data) {
      byte = pattern % 3 == 0 ? 0 : pattern % 3 == 1 ? 0xE0 : static_cast<std::uint8_t>(random());
    }
    std::size_t phase = 0;
    const std::size_t total = fd(id, extended, data, brs, phase).size();
    const FrameBits bits = fd_frame_bits(id, extended, data, brs);
    ASSERT_EQ(bits.nominal + bits.data, total) << i;
    ASSERT_EQ(bits.data, brs ? phase : 0) << i;
  }
}

TEST(FrameBits, FdLengthCodesAreThoseOfTheStandardAndOthersHaveNone) {
  EXPECT_EQ(fd_length_code(8), 8);
  EXPECT_EQ(fd_length_code(12), 9);
  EXPECT_EQ(fd_length_code(64), 15);
  EXPECT_EQ(fd_length_code(9), -1);
  EXPECT_EQ(fd_length_code(65), -1);
}

}  // namespace
}  // namespace tenon::sim
