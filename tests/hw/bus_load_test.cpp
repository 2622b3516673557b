#include "hw/bus_load/bus_load.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/hw/gantry_on_bus.h"
#include "tests/support/refusal.h"

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

Robot six_axes(int targets_per_frame) {
  Robot robot = gantry_robot();
  robot.joints.resize(6, robot.joints.front());
  robot.targets_per_frame = targets_per_frame;
  return robot;
}

TEST(BusLoad, PackedTargetsMakeSixAxesFitTwoMilliseconds) {
  // SYNC 47 + 3 * 111 + 6 * 111 + 2 * 111 = 1268 bits in 2000; worst 55 + 11 * 135 = 1540.
  const BusLoad load = bus_load(six_axes(2));
  EXPECT_EQ(load.frames_per_cycle, 12u);
  EXPECT_EQ(load.nominal_bits, 1268u);
  EXPECT_EQ(load.worst_bits, 1540u);
  EXPECT_NO_THROW(check_bus_load(six_axes(2)));
  // Even with all controlwords in it a cycle is not too short.
  EXPECT_EQ(load.worst_bits + 6 * worst_frame_bits(2), 1990u);
}

TEST(BusLoad, TheLastOfAnOddNumberOfPackedTargetsHasFourBytes) {
  // SYNC 47 + 111 + (47 + 32) + 3 * 111 + 2 * 111.
  Robot robot = gantry_robot();
  robot.targets_per_frame = 2;
  EXPECT_EQ(bus_load(robot).nominal_bits, 792u);
  EXPECT_EQ(bus_load(robot).frames_per_cycle, 8u);
}

std::string load_refusal(const Robot& robot) {
  return tests::refusal([&] { check_bus_load(robot); });
}

TEST(BusLoad, TooManyFramesAreRefusedWithTheNumbers) {
  Robot robot = gantry_robot();
  robot.cycle_us = 1000;
  EXPECT_EQ(load_refusal(robot),
            "robot 'gantry': 9 frames every 1000 us load a bus of 1000000 bit/s with 88.7 % "
            "(107.5 % in the worst case of stuffing), allowed are 85 %; take a cycle of at "
            "least 2000 us");
}

TEST(BusLoad, TheRefusalNamesPackingWhereItHelps) {
  // SYNC 47 + 6 (95 + 111) + 2 * 111 = 1505 bits in 2000; worst 55 + 6 (115 + 135) + 270 = 1825.
  EXPECT_EQ(load_refusal(six_axes(1)),
            "robot 'gantry': 15 frames every 2000 us load a bus of 1000000 bit/s with 75.2 % "
            "(91.2 % in the worst case of stuffing), allowed are 85 %; take targets_per_frame: 2 "
            "or a cycle of at least 3000 us");
}

}  // namespace
}  // namespace tenon::hw
