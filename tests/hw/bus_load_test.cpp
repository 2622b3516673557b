#include "hw/bus_load.h"

#include <gtest/gtest.h>

#include <string>

#include "shared/base/error.h"
#include "tests/hw/gantry_on_bus.h"

namespace tenon::hw {
namespace {

TEST(BusLoad, FrameLengthsByTheFormula) {
  EXPECT_EQ(nominal_frame_bits(0), 47u);
  EXPECT_EQ(nominal_frame_bits(8), 111u);
  EXPECT_EQ(worst_frame_bits(0), 55u);
  EXPECT_EQ(worst_frame_bits(6), 115u);
  EXPECT_EQ(worst_frame_bits(8), 135u);
}

TEST(BusLoad, GantryTakesFortyFourPercent) {
  // SYNC 47 + 3 (95 + 111) + 2 * 111 = 887 bits in 2000; worst 55 + 3 (115 + 135) + 270 = 1075.
  const BusLoad load = bus_load(gantry_robot());
  EXPECT_EQ(load.frames_per_cycle, 9u);
  EXPECT_EQ(load.nominal_bits, 887u);
  EXPECT_EQ(load.worst_bits, 1075u);
  EXPECT_DOUBLE_EQ(load.nominal, 0.4435);
  EXPECT_DOUBLE_EQ(load.worst, 0.5375);
  EXPECT_NO_THROW(check_bus_load(gantry_robot()));
}

TEST(BusLoad, TooManyFramesAreRefusedWithTheNumbers) {
  Robot robot = gantry_robot();
  robot.cycle_us = 1000;
  try {
    check_bus_load(robot);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "robot 'gantry': 9 frames every 1000 us load a bus of 1000000 bit/s with 88.7 % "
                 "(107.5 % in the worst case of stuffing), allowed are 85 %; take a cycle of at "
                 "least 2000 us");
  }
}

}  // namespace
}  // namespace tenon::hw
