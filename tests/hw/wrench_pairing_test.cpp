#include "hw/sensors/wrench_pairing.h"

#include <gtest/gtest.h>

namespace tenon::hw {
namespace {

WrenchHalf force(std::int16_t value, std::uint16_t counter) { return {0, {value, 0, -2}, counter}; }
WrenchHalf torque(std::int16_t value, std::uint16_t counter) {
  return {1, {value, 0, -2}, counter};
}

TEST(WrenchPairing, JoinsHalvesOfOneSampleInEitherOrder) {
  WrenchPairing pairing;
  EXPECT_FALSE(pairing.process(force(7, 0x0102)));
  const auto sample = pairing.process(torque(9, 0x0102));
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->counts, (std::array<std::int16_t, 6>{7, 0, -2, 9, 0, -2}));
  EXPECT_EQ(sample->counter, 0x0102);
  EXPECT_FALSE(sample->repeated);
  EXPECT_FALSE(pairing.process(torque(1, 0x0103)));
  EXPECT_TRUE(pairing.process(force(1, 0x0103)));
  EXPECT_EQ(pairing.torn(), 0u);
}

TEST(WrenchPairing, LostHalfCostsOneSampleAndIsCounted) {
  WrenchPairing pairing;
  (void)pairing.process(force(1, 1));  // its torque is lost
  EXPECT_FALSE(pairing.process(force(2, 2)));
  EXPECT_TRUE(pairing.process(torque(2, 2)));
  EXPECT_EQ(pairing.torn(), 1u);
  (void)pairing.process(torque(3, 3));  // its force is lost
  EXPECT_FALSE(pairing.process(force(4, 4)));
  EXPECT_TRUE(pairing.process(torque(4, 4)));
  EXPECT_EQ(pairing.torn(), 2u);
}

TEST(WrenchPairing, CounterMayWrap) {
  WrenchPairing pairing;
  (void)pairing.process(force(1, 0xFFFF));
  EXPECT_FALSE(pairing.process(torque(1, 0x0000)));  // newer, kept
  EXPECT_TRUE(pairing.process(force(1, 0x0000)));
}

TEST(WrenchPairing, RepeatedSampleSaysSo) {
  WrenchPairing pairing;
  for (const bool repeated : {false, true}) {
    (void)pairing.process(force(1, 5));
    const auto sample = pairing.process(torque(1, 5));
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->repeated, repeated);
  }
}

}  // namespace
}  // namespace tenon::hw
