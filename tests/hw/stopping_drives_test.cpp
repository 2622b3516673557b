// How drives are stopped and switched off where their answers or their manners leave something to
// be wished.

#include <gtest/gtest.h>

#include <set>

#include "tests/hw/gantry_on_bus.h"

namespace tenon::hw {
namespace {

std::set<int> controlwords(const ScriptedNode& node) {
  std::set<int> words;
  for (const CanFrame& frame : node.commands) words.insert(frame.data[0]);
  return words;
}

TEST(StoppingDrives, ADriveInItsQuickStopIsLeftToItsRampAndItsBrake) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  for (int i = 0; i < 2; ++i) gantry.cycle(ArmRequest::kQuickStop);
  for (const auto& node : gantry.nodes) node->commands.clear();
  ASSERT_TRUE(gantry.run_until(ArmState::kDisabled, ArmRequest::kDisabled));
  EXPECT_EQ(controlwords(*gantry.nodes[2]), (std::set<int>{0x02})) << "disable voltage drops it";
}

TEST(StoppingDrives, OneThatStaysInItsQuickStopLosesItsVoltageInTheEnd) {
  GantryOnBus gantry;
  gantry.nodes[2]->stays_in_quick_stop = true;
  ASSERT_TRUE(gantry.prepare_and_enable());
  for (int i = 0; i < 4; ++i) gantry.cycle(ArmRequest::kQuickStop);
  EXPECT_FALSE(gantry.run_until(ArmState::kDisabled, ArmRequest::kDisabled));
  EXPECT_TRUE(gantry.run_until(ArmState::kDisabled, ArmRequest::kDisabled, 400));
  EXPECT_EQ(gantry.nodes[2]->statusword, 0x0250);
}

// Whatever the cycle: well within the three seconds that the executor waits.
TEST(StoppingDrives, ThePatienceWithItIsASecondOfCyclesOfAnyLength) {
  for (const std::uint32_t cycle_us : {2000U, 10000U}) {
    Robot robot = gantry_robot();
    robot.cycle_us = cycle_us;
    GantryOnBus gantry(robot);
    gantry.nodes[2]->stays_in_quick_stop = true;
    ASSERT_TRUE(gantry.prepare_and_enable());
    for (int i = 0; i < 4; ++i) gantry.cycle(ArmRequest::kQuickStop);
    int cycles = 0;
    for (; cycles < 2000 && gantry.nodes[2]->statusword != 0x0250; ++cycles) {
      gantry.cycle(ArmRequest::kDisabled);
    }
    EXPECT_NEAR(cycles, 1e6 / cycle_us, 3.0) << cycle_us;
  }
}

TEST(StoppingDrives, OneWhoseAnswersAreLostIsStoppedAndSwitchedOffAllTheSame) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[0]->answers_sync = false;
  for (int i = 0; i < 8; ++i) gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kFeedbackMissing);
  for (int i = 0; i < 20; ++i) gantry.cycle(ArmRequest::kDisabled);
  EXPECT_EQ(gantry.nodes[0]->statusword, 0x0250) << "its last word was: operation enabled";
  EXPECT_EQ(gantry.feedback.joints_off, 0b110U) << "nobody has heard that it is off";
}

TEST(StoppingDrives, InAFaultTheDrivesOwnWordsSayThatTheyAreOff) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[3]->answers_sync = false;
  for (int i = 0; i < 8; ++i) gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.arm.state(), ArmState::kFault);
  EXPECT_EQ(gantry.feedback.joints_off, 0U);
  for (int i = 0; i < 20; ++i) gantry.cycle(ArmRequest::kDisabled);
  EXPECT_EQ(gantry.arm.state(), ArmState::kFault);
  EXPECT_EQ(gantry.feedback.joints_off, 0b111U);
}

}  // namespace
}  // namespace tenon::hw
