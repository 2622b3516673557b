// The slcan codec against literal lines, and against garbage.

#include "hw/can/slcan.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>
#include <vector>

namespace tenon::hw {
namespace {

using Kind = SlcanParser::Message::Kind;

std::string encoded(const CanFrame& frame) {
  std::array<char, kSlcanMaxFrame> line{};
  const std::size_t size = slcan_encode(frame, line);
  return {line.data(), size};
}

std::vector<SlcanParser::Message> parsed(SlcanParser& parser, const std::string& text) {
  std::vector<SlcanParser::Message> messages;
  for (const char character : text) {
    if (const auto message = parser.push(character)) messages.push_back(*message);
  }
  return messages;
}

const CanFrame kSetpoint{0x201, false, false, 6, {0x0F, 0x00, 0x90, 0xD0, 0x03, 0x00, 0, 0}};

TEST(Slcan, FramesAreTheLiteralLines) {
  EXPECT_EQ(encoded(kSetpoint), "t20160F0090D00300\r");
  EXPECT_EQ(encoded({0x080, false, false, 0, {}}), "t0800\r");
  EXPECT_EQ(encoded({0x1ABCDEF0, true, false, 1, {0xA5}}), "T1ABCDEF01A5\r");
  EXPECT_EQ(encoded({0x7FF, false, true, 4, {}}), "r7FF4\r");
  EXPECT_EQ(encoded({0x12345, true, true, 8, {}}), "R000123458\r");
  CanFrame longest{0x1FFFFFFF, true, false, 8, {}};
  longest.data.fill(0xFF);
  EXPECT_EQ(encoded(longest), "T1FFFFFFF8FFFFFFFFFFFFFFFF\r");
}

TEST(Slcan, LinesParseToTheSameFrames) {
  SlcanParser parser;
  const auto messages = parsed(parser,
                               "t20160F0090D00300\rt0800\rT1abcdef01a5\rr7FF4\r"
                               "t08010A1234\r");  // with a timestamp
  ASSERT_EQ(messages.size(), 5u);
  EXPECT_EQ(messages[0].frame, kSetpoint);
  EXPECT_EQ(messages[1].frame, (CanFrame{0x080, false, false, 0, {}}));
  EXPECT_EQ(messages[2].frame, (CanFrame{0x1ABCDEF0, true, false, 1, {0xA5}}));
  EXPECT_EQ(messages[3].frame, (CanFrame{0x7FF, false, true, 4, {}}));
  EXPECT_EQ(messages[4].frame, (CanFrame{0x080, false, false, 1, {0x0A}}));
  EXPECT_EQ(parser.malformed(), 0u);
}

TEST(Slcan, AnswersAndCommandsAreToldApart) {
  SlcanParser parser;
  std::vector<Kind> kinds;
  for (const auto& message : parsed(parser, "\r\az\rZ\rV1013\rO\r")) kinds.push_back(message.kind);
  EXPECT_EQ(kinds, (std::vector<Kind>{Kind::kAccepted, Kind::kRefused, Kind::kAccepted,
                                      Kind::kAccepted, Kind::kCommand, Kind::kCommand}));
}

TEST(Slcan, MalformedLinesAreDroppedAndCountedAndTheNextIsRead) {
  const std::vector<std::string> bad{"t20",
                                     "t2019",
                                     "t8000",
                                     "t20160F0090D003",
                                     "t20160F0090D0030012",
                                     "tXYZ0",
                                     "T200000000",
                                     "t2012AG00",
                                     "?",
                                     "r80000",
                                     "t-010",
                                     "T1ABCDEF",
                                     std::string(31, 't'),
                                     std::string(5000, '0'),
                                     "t0\a80"};
  SlcanParser parser;
  for (std::size_t i = 0; i < bad.size(); ++i) {
    EXPECT_TRUE(parsed(parser, bad[i] + "\r").empty()) << bad[i];
    EXPECT_EQ(parser.malformed(), i + 1) << bad[i];
    EXPECT_EQ(parsed(parser, "t0800\r").size(), 1u);
  }
}

TEST(Slcan, DamagedLinesNeverGiveAFrameOutOfBounds) {
  const unsigned seed = 7;
  std::mt19937 random(seed);
  const std::string letters = "tTrR0123456789ABCDEFabcdef\r\a\nzZCOSVX";
  SlcanParser parser;
  int frames = 0;
  for (int i = 0; i < 50'000; ++i) {
    CanFrame frame{static_cast<std::uint32_t>(random()),
                   random() % 2 == 0,
                   random() % 4 == 0,
                   static_cast<std::uint8_t>(random() % 9),
                   {}};
    frame.id &= frame.extended ? 0x1FFFFFFFu : 0x7FFu;
    std::string line = encoded(frame);
    for (char& character : line) {
      if (random() % 20 == 0) character = letters[random() % letters.size()];
      if (random() % 100 == 0) character = static_cast<char>(random() & 0xFF);
    }
    for (const auto& message : parsed(parser, line)) {
      if (message.kind != Kind::kFrame) continue;
      ++frames;
      ASSERT_LE(message.frame.length, 8) << "seed " << seed;
      ASSERT_LE(message.frame.id, message.frame.extended ? 0x1FFFFFFFu : 0x7FFu);
      SlcanParser again;
      const auto copy = parsed(again, encoded(message.frame));
      ASSERT_EQ(copy.size(), 1u);
      ASSERT_EQ(copy[0].frame, message.frame);
    }
  }
  EXPECT_GT(frames, 10'000);
  EXPECT_GT(parser.malformed(), 10'000u);
}

TEST(Slcan, BitratesHaveTheirDigits) {
  EXPECT_EQ(slcan_bitrate_digit(10'000), '0');
  EXPECT_EQ(slcan_bitrate_digit(500'000), '6');
  EXPECT_EQ(slcan_bitrate_digit(1'000'000), '8');
  EXPECT_FALSE(slcan_bitrate_digit(999'999));
}

}  // namespace
}  // namespace tenon::hw
