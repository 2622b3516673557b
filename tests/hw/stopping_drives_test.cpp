// How drives are stopped and switched off where their answers or their manners leave something to
// be wished.

#include <gtest/gtest.h>

#include <cstdint>
#include <set>

#include "hw/arm/braking_watch.h"
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

// It has lost nothing but its master, says so, and waits in pre-operational.
void miss_the_master(ScriptedNode& node, std::uint32_t emergency_id) {
  node.send(emergency_id, {0x30, 0x81, 0x11, 0, 0, 0, 0, 0});
  node.nmt_state = 0x7F;
  node.statusword = 0x0250;
}

TEST(StoppingDrives, OneThatHasMissedTheMasterIsStartedAgainAndSaysThatItIsOff) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  miss_the_master(*gantry.nodes[0], 0x081);
  gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.arm.state(), ArmState::kFault);
  for (int i = 0; i < 100; ++i) gantry.cycle(ArmRequest::kDisabled);
  EXPECT_EQ(gantry.nodes[0]->nmt_state, 0x05);
  EXPECT_EQ(gantry.feedback.joints_off, 0b111U);
}

// After a reset its process data are not what they were; why the third waits, nobody knows.
TEST(StoppingDrives, OneThatWasResetOrWaitsForAnotherReasonIsLeftAlone) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  miss_the_master(*gantry.nodes[1], 0x082);
  gantry.nodes[1]->reboot();
  gantry.nodes[1]->objects[0x101700].value = 100;  // it goes on to say where it is
  gantry.nodes[2]->nmt_state = 0x7F;
  for (int i = 0; i < 200; ++i) gantry.cycle(ArmRequest::kDisabled);
  EXPECT_EQ(gantry.nodes[1]->nmt_state, 0x7F);
  EXPECT_EQ(gantry.nodes[2]->nmt_state, 0x7F);
}

TEST(StoppingDrives, OneThatAnotherMasterMayHaveIsLeftAlone) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[1]->send(0x000, {0x80, 0x7E});
  gantry.cycle(ArmRequest::kDisabled);
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kOtherMaster);
  miss_the_master(*gantry.nodes[0], 0x081);
  for (int i = 0; i < 100; ++i) gantry.cycle(ArmRequest::kDisabled);
  EXPECT_EQ(gantry.nodes[0]->nmt_state, 0x7F);
}

// 0.5 m/s at 1e6 counts a metre and 2 ms are 1000 counts a cycle.
class AxisThatIsToStop : public ::testing::Test {
 protected:
  /// @return after how many cycles it is found out, of at most so many; 0: it is not
  int found_out(int counts_a_cycle, int cycles, int jump_at = -1, int gain = 0) {
    BrakingWatch watch(joint(), 2000);
    std::int32_t at = 0;
    for (int i = 1; i <= cycles; ++i) {
      at += i == jump_at ? 100'000 : counts_a_cycle + gain * i;
      watch.update(at, true);
      if (watch.runs_on()) return i;
    }
    return 0;
  }
  static Joint joint() {
    Joint joint = gantry_robot().joints.front();
    joint.speed_max = 0.5;
    joint.acceleration_max = 5.0;
    return joint;
  }
};

TEST_F(AxisThatIsToStop, MayGoAtItsFullSpeedUntilItsRampIsOver) {
  EXPECT_EQ(found_out(1000, 99), 0);
  // 0.1 s of ramp and 0.1 s of margin, then three cycles.
  EXPECT_EQ(found_out(1000, 200), 103);
}

// The first position has none before it, the second makes the speed that it had.
TEST_F(AxisThatIsToStop, IsFoundOutOnceItIsFasterByAQuarterOfItsFullSpeed) {
  EXPECT_EQ(found_out(100, 50, -1, 30), 13) << "three cycles beyond 160 and 250";
  EXPECT_EQ(found_out(100, 90, -1, 2), 0);
  EXPECT_EQ(found_out(1600, 50), 4) << "nothing is that fast";
}

TEST_F(AxisThatIsToStop, IsNotFoundOutByOnePositionThatJumps) {
  EXPECT_EQ(found_out(0, 500, 2), 0);
  EXPECT_EQ(found_out(0, 500, 20), 0);
  EXPECT_EQ(found_out(0, 500, 200), 0);
}

TEST_F(AxisThatIsToStop, IsNotJudgedByWhatItDidNotAnswer) {
  BrakingWatch watch(joint(), 2000);
  for (int i = 1; i <= 90; ++i) watch.update(i * 2000, i % 2 == 0);
  EXPECT_FALSE(watch.runs_on());
}

// By its answers it runs away from the ramp that it says it follows.
TEST(StoppingDrives, OneThatRunsOnInItsQuickStopLosesItsVoltageAtOnce) {
  GantryOnBus gantry;
  gantry.nodes[2]->stays_in_quick_stop = true;
  ASSERT_TRUE(gantry.prepare_and_enable());
  for (int i = 0; i < 12; ++i) {
    gantry.nodes[2]->position_counts += 100'000;
    gantry.cycle(ArmRequest::kQuickStop);
  }
  EXPECT_EQ(gantry.nodes[2]->statusword, 0x0250);
  EXPECT_EQ(gantry.arm.counters().unbraked_axes, 1U);
  EXPECT_EQ(controlwords(*gantry.nodes[1]).count(0x00), 0U) << "the others are left to their ramps";
}

}  // namespace
}  // namespace tenon::hw
