// The master's frames of motors in MIT mode against bytes written by hand from the byte table.
// Ranges 12.5 rad, 30 rad/s, 10 Nm: 1 rad is 13.5 / 25 x 65535 = 35389 = 8A3Dh, 1 rad/s is
// 31 / 60 x 4095 = 2116 = 844h, 10 Nm/rad is 82 = 052h, 1 Nm s/rad is 819 = 333h, 1 Nm is 8CCh.

#include <gtest/gtest.h>

#include <array>

#include "hw/mit/motor_bring_up.h"
#include "hw/mit/motor_frames.h"
#include "shared/cell/robot.h"
#include "shared/mit/constants.h"

namespace tenon::hw::mit {
namespace {

using Bytes = std::array<std::uint8_t, 8>;

MitMotor motor() {
  MitMotor it;
  it.feedback_id = 0x11;
  return it;
}

CanFrame frame_of(std::uint32_t id, const Bytes& bytes) {
  CanFrame frame;
  frame.id = id;
  frame.length = 8;
  frame.data = bytes;
  return frame;
}

TEST(MitFrames, CommandOfNothingIsTheMiddleOfEveryRangeWithoutGains) {
  EXPECT_EQ(command_frame(1, motor(), {}),
            frame_of(0x001, {0x7F, 0xFF, 0x7F, 0xF0, 0x00, 0x00, 0x07, 0xFF}));
}

TEST(MitFrames, CommandOfOneOfEach) {
  EXPECT_EQ(command_frame(3, motor(), {1.0, 1.0, 10.0, 1.0, 1.0}),
            frame_of(0x003, {0x8A, 0x3D, 0x84, 0x40, 0x52, 0x33, 0x38, 0xCC}));
}

TEST(MitFrames, CommandAtAndBeyondTheEndsOfTheRanges) {
  const CanFrame ends = frame_of(0x001, {0xFF, 0xFF, 0x00, 0x0F, 0xFF, 0xFF, 0xFF, 0xFF});
  EXPECT_EQ(command_frame(1, motor(), {12.5, -30.0, 500.0, 5.0, 10.0}), ends);
  EXPECT_EQ(command_frame(1, motor(), {99.0, -99.0, 999.0, 9.0, 99.0}), ends);
  EXPECT_EQ(command_frame(1, motor(), {-12.5, 30.0, 250.0, 2.5, -10.0}),
            frame_of(0x001, {0x00, 0x00, 0xFF, 0xF7, 0xFF, 0x7F, 0xF0, 0x00}));
}

TEST(MitFrames, SpecialFrames) {
  const auto special = [](std::uint8_t last) {
    return frame_of(0x002, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, last});
  };
  EXPECT_EQ(special_frame(2, tenon::mit::kEnable), special(0xFC));
  EXPECT_EQ(special_frame(2, tenon::mit::kDisable), special(0xFD));
  EXPECT_EQ(special_frame(2, tenon::mit::kClearError), special(0xFB));
}

TEST(MitFrames, AFeedbackIsAskedForByItself) {
  EXPECT_EQ(request_feedback_frame(5), frame_of(0x7FF, {0x05, 0x00, 0xCC, 0, 0, 0, 0, 0}));
}

TEST(MitFrames, RegistersAreAskedAndWritten) {
  EXPECT_EQ(read_register_frame(1, 7), frame_of(0x7FF, {1, 0, 0x33, 0x07, 0, 0, 0, 0}));
  EXPECT_EQ(write_register_frame(2, 10, 1), frame_of(0x7FF, {2, 0, 0x55, 0x0A, 1, 0, 0, 0}));
  // 20 ms in 50 us.
  EXPECT_EQ(write_register_frame(1, 9, 400), frame_of(0x7FF, {1, 0, 0x55, 0x09, 0x90, 1, 0, 0}));
}

TEST(MitFrames, FeedbackInSi) {
  const auto told = decode_feedback(
      1, motor(), frame_of(0x011, {0x11, 0x8A, 0x3D, 0x84, 0x48, 0xCC, 0x19, 0x1A}));
  ASSERT_TRUE(told);
  EXPECT_EQ(told->state, 1);
  EXPECT_NEAR(told->position_rad, 1.0, 2e-4);
  EXPECT_NEAR(told->velocity_radps, 1.0, 8e-3);
  EXPECT_NEAR(told->torque_Nm, 1.0, 3e-3);
}

TEST(MitFrames, FeedbackNamesTheErrorInItsHighHalf) {
  for (const unsigned error : {0x8U, 0x9U, 0xAU, 0xBU, 0xCU, 0xDU, 0xEU}) {
    const auto first = static_cast<std::uint8_t>(error << 4U | 1U);
    const auto told =
        decode_feedback(1, motor(), frame_of(0x011, {first, 0x7F, 0xFF, 0x7F, 0xF7, 0xFF, 0, 0}));
    ASSERT_TRUE(told);
    EXPECT_EQ(told->state, error);
  }
}

TEST(MitFrames, FeedbackOfAnotherMotorOrLengthIsNone) {
  const Bytes bytes = {0x11, 0x7F, 0xFF, 0x7F, 0xF7, 0xFF, 0, 0};
  EXPECT_FALSE(decode_feedback(2, motor(), frame_of(0x011, bytes)));
  EXPECT_FALSE(decode_feedback(1, motor(), frame_of(0x012, bytes)));
  CanFrame shorter = frame_of(0x011, bytes);
  shorter.length = 7;
  EXPECT_FALSE(decode_feedback(1, motor(), shorter));
  CanFrame extended = frame_of(0x011, bytes);
  extended.extended = true;
  EXPECT_FALSE(decode_feedback(1, motor(), extended));
}

TEST(MitFrames, RegisterAnswers) {
  // PMAX of motor 1 is 12.5, a float: 41480000h.
  const auto answer =
      decode_register(1, motor(), frame_of(0x011, {1, 0, 0x33, 0x15, 0x00, 0x00, 0x48, 0x41}));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->number, 21);
  EXPECT_EQ(answer->value, 0x41480000U);
  EXPECT_FALSE(decode_register(2, motor(), frame_of(0x011, {1, 0, 0x33, 0x15, 0, 0, 0x48, 0x41})));
  EXPECT_FALSE(decode_register(1, motor(), frame_of(0x011, {1, 0, 0xCC, 0x15, 0, 0, 0x48, 0x41})));
}

}  // namespace
}  // namespace tenon::hw::mit
