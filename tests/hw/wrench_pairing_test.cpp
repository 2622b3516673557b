#include "hw/arm/wrench_pairing.h"

#include <gtest/gtest.h>

namespace tenon::hw {
namespace {

using Half = WrenchPairing::Half;

CanFrame half_frame(std::uint8_t value, std::uint16_t counter) {
  CanFrame frame;
  frame.length = 8;
  frame.data = {value,
                0,
                0,
                0,
                0xFE,
                0xFF,
                static_cast<std::uint8_t>(counter & 0xFF),
                static_cast<std::uint8_t>(counter >> 8)};
  return frame;
}

TEST(WrenchPairing, JoinsHalvesOfOneSampleInEitherOrder) {
  WrenchPairing pairing;
  EXPECT_FALSE(pairing.process(Half::kForce, half_frame(7, 0x0102)));
  const auto sample = pairing.process(Half::kTorque, half_frame(9, 0x0102));
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->counts, (std::array<std::int16_t, 6>{7, 0, -2, 9, 0, -2}));
  EXPECT_EQ(sample->counter, 0x0102);
  EXPECT_FALSE(sample->repeated);
  EXPECT_FALSE(pairing.process(Half::kTorque, half_frame(1, 0x0103)));
  EXPECT_TRUE(pairing.process(Half::kForce, half_frame(1, 0x0103)));
  EXPECT_EQ(pairing.torn(), 0u);
}

TEST(WrenchPairing, LostHalfCostsOneSampleAndIsCounted) {
  WrenchPairing pairing;
  (void)pairing.process(Half::kForce, half_frame(1, 1));  // its torque is lost
  EXPECT_FALSE(pairing.process(Half::kForce, half_frame(2, 2)));
  EXPECT_TRUE(pairing.process(Half::kTorque, half_frame(2, 2)));
  EXPECT_EQ(pairing.torn(), 1u);
  (void)pairing.process(Half::kTorque, half_frame(3, 3));  // its force is lost
  EXPECT_FALSE(pairing.process(Half::kForce, half_frame(4, 4)));
  EXPECT_TRUE(pairing.process(Half::kTorque, half_frame(4, 4)));
  EXPECT_EQ(pairing.torn(), 2u);
}

TEST(WrenchPairing, CounterMayWrap) {
  WrenchPairing pairing;
  (void)pairing.process(Half::kForce, half_frame(1, 0xFFFF));
  EXPECT_FALSE(pairing.process(Half::kTorque, half_frame(1, 0x0000)));  // newer, kept
  EXPECT_TRUE(pairing.process(Half::kForce, half_frame(1, 0x0000)));
}

TEST(WrenchPairing, RepeatedSampleSaysSo) {
  WrenchPairing pairing;
  for (const bool repeated : {false, true}) {
    (void)pairing.process(Half::kForce, half_frame(1, 5));
    const auto sample = pairing.process(Half::kTorque, half_frame(1, 5));
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->repeated, repeated);
  }
}

}  // namespace
}  // namespace tenon::hw
