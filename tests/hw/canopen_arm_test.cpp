#include "hw/arm/canopen_arm.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "hw/arm/describe_fault.h"
#include "tests/hw/gantry_on_bus.h"
#include "tests/support/frame_filter.h"

namespace tenon::hw {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const CanFrame& frame) {
  return {frame.data.begin(), frame.data.begin() + frame.length};
}

/// The last RPDO of a node.
Bytes last_command(const GantryOnBus& gantry, std::size_t i) {
  return bytes_of(gantry.nodes[i]->commands.back());
}

TEST(CanopenArm, EnablesEveryDriveWithTheTargetAtTheActualPosition) {
  GantryOnBus gantry;
  gantry.nodes[0]->position_counts = 250000;
  ASSERT_TRUE(gantry.prepare());
  EXPECT_EQ(gantry.arm.state(), ArmState::kDisabled);
  ASSERT_TRUE(gantry.run_until(ArmState::kEnabled, ArmRequest::kEnabled));
  std::vector<std::uint16_t> controlwords;
  for (const CanFrame& frame : gantry.nodes[0]->commands) {
    // 250000 = 0x0003D090, always the target, because nothing has moved yet.
    EXPECT_EQ((Bytes{frame.data.begin() + 2, frame.data.begin() + 6}),
              (Bytes{0x90, 0xD0, 0x03, 0x00}));
    if (controlwords.empty() || controlwords.back() != frame.data[0]) {
      controlwords.push_back(frame.data[0]);
    }
  }
  EXPECT_EQ(controlwords, (std::vector<std::uint16_t>{0x06, 0x07, 0x0F}));
}

TEST(CanopenArm, SetpointOfAQuarterMetreIs250000CountsOnTheWire) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.cycle(ArmRequest::kEnabled, {0.25, -0.1, 0.0});
  gantry.step_nodes();
  EXPECT_EQ(last_command(gantry, 0), (Bytes{0x0F, 0x00, 0x90, 0xD0, 0x03, 0x00}));
  EXPECT_EQ(last_command(gantry, 1), (Bytes{0x0F, 0x00, 0x60, 0x79, 0xFE, 0xFF}));
  EXPECT_EQ(last_command(gantry, 2), (Bytes{0x0F, 0x00, 0x00, 0x00, 0x00, 0x00}));
}

TEST(CanopenArm, FeedbackIsInSiUnits) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare());
  gantry.nodes[0]->position_counts = 123456;
  gantry.nodes[1]->position_counts = -500000;
  gantry.nodes[2]->torque_permille = -250;
  gantry.nodes[3]->wrench_counts = {100, -200, 300, 10, -20, 30};
  EXPECT_TRUE(gantry.cycle(ArmRequest::kDisabled));
  EXPECT_DOUBLE_EQ(gantry.feedback.position[0], 0.123456);
  EXPECT_DOUBLE_EQ(gantry.feedback.position[1], -0.5);
  EXPECT_DOUBLE_EQ(gantry.feedback.effort[2], -50.0);
  EXPECT_EQ(gantry.feedback.joints_fresh, 7u);
  EXPECT_TRUE(gantry.feedback.wrench_fresh);
  const std::array<double, 6> expected{1.0, -2.0, 3.0, 0.005, -0.01, 0.015};
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(gantry.feedback.wrench[i], expected[static_cast<std::size_t>(i)], 1e-12);
  }
  EXPECT_EQ(gantry.feedback.wrench_counter, 1u);
}

TEST(CanopenArm, MasterHeartbeatLeavesEvery100Milliseconds) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare());
  std::vector<std::int64_t> times;
  const tests::FrameFilter filter(gantry.bus, [&](CanFrame& frame, std::size_t) {
    if (frame.id == 0x77F) {
      EXPECT_EQ(bytes_of(frame), Bytes{0x05});
      times.push_back(gantry.now_ns);
    }
    return true;
  });
  for (int i = 0; i < 500; ++i) gantry.cycle(ArmRequest::kDisabled);
  EXPECT_EQ(times.size(), 10u);
}

TEST(CanopenArm, AQuickStopEndsWithDrivesThatAreOffAndCanBeEnabledAgain) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  for (int i = 0; i < 4; ++i) gantry.cycle(ArmRequest::kQuickStop);
  EXPECT_EQ(gantry.arm.state(), ArmState::kStopping);
  EXPECT_EQ(gantry.nodes[0]->statusword, 0x0217);
  EXPECT_TRUE(gantry.run_until(ArmState::kEnabled, ArmRequest::kEnabled));
  for (int i = 0; i < 4; ++i) gantry.cycle(ArmRequest::kQuickStop);
  EXPECT_TRUE(gantry.run_until(ArmState::kDisabled, ArmRequest::kDisabled));
}

TEST(CanopenArm, DisablingWalksDownByDisableOperationAndShutdown) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[0]->commands.clear();
  ASSERT_TRUE(gantry.run_until(ArmState::kDisabled, ArmRequest::kDisabled));
  for (int i = 0; i < 3; ++i) gantry.cycle(ArmRequest::kDisabled);
  std::vector<int> controlwords;
  for (const CanFrame& frame : gantry.nodes[0]->commands) {
    if (controlwords.empty() || controlwords.back() != frame.data[0]) {
      controlwords.push_back(frame.data[0]);
    }
  }
  EXPECT_EQ(controlwords, (std::vector<int>{0x0F, 0x07, 0x06, 0x00}));
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kNone);
}

TEST(CanopenArm, FaultFromBeforeIsResetByEnabling) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare());
  gantry.nodes[1]->statusword = 0x0218;
  for (int i = 0; i < 3; ++i) gantry.cycle(ArmRequest::kDisabled);
  EXPECT_EQ(gantry.arm.state(), ArmState::kDisabled);
  EXPECT_TRUE(gantry.run_until(ArmState::kEnabled, ArmRequest::kEnabled));
}

TEST(CanopenArm, DriveThatDoesNotEnableIsNamedAfterTwoSeconds) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare());
  gantry.nodes[2]->stuck = true;
  ASSERT_TRUE(gantry.run_until(ArmState::kFault, ArmRequest::kEnabled, 1100));
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kDriveState);
  EXPECT_EQ(gantry.arm.fault().node, 3);
  EXPECT_EQ(gantry.arm.fault().code, 0x0250u);
}

TEST(CanopenArm, EnabledDriveHoldsWhileItWaitsForTheOthers) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare());
  gantry.nodes[1]->stuck = true;
  gantry.nodes[0]->follows = false;
  gantry.nodes[0]->position_counts = 1000;
  for (int i = 0; i < 10; ++i) gantry.cycle(ArmRequest::kEnabled);
  ASSERT_EQ(gantry.nodes[0]->statusword, 0x0237);
  gantry.nodes[0]->position_counts = 900;  // it sags
  for (int i = 0; i < 3; ++i) gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.nodes[0]->target_counts, 1000);
}

TEST(CanopenArm, FaultOfADriveQuickStopsTheOthers) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[0]->statusword = 0x0218;
  gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.arm.state(), ArmState::kFault);
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kDriveFault);
  EXPECT_EQ(gantry.arm.fault().node, 1);
  gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.nodes[1]->controlword, 0x02);
  for (int i = 0; i < 10; ++i) gantry.cycle(ArmRequest::kDisabled);
  EXPECT_EQ(gantry.nodes[1]->statusword, 0x0250);
  EXPECT_EQ(gantry.arm.state(), ArmState::kFault);
}

TEST(CanopenArm, EmergencyNamesTheErrorCode) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[2]->send(0x083, {0x11, 0x86, 0x20, 0, 0, 0, 0, 0});
  gantry.cycle(ArmRequest::kEnabled);
  const ArmFault fault = gantry.arm.fault();
  EXPECT_EQ(fault.kind, ArmFaultKind::kDriveFault);
  EXPECT_EQ(fault.node, 3);
  EXPECT_EQ(fault.code, 0x8611u);
  EXPECT_EQ(describe(fault, gantry.robot),
            "node 3 (z): drive fault 0x8611 (following error); see the drive's manual for the "
            "code");
}

TEST(CanopenArm, EmergencyOfTheMakersOwnIsANumberWithoutAGuess) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[2]->send(0x083, {0x85, 0x73, 0x20, 0, 0, 0, 0, 0});
  gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(describe(gantry.arm.fault(), gantry.robot),
            "node 3 (z): drive fault 0x7385; see the drive's manual for the code");
}

TEST(CanopenArm, EmergencyAfterTheStatuswordRefinesTheFault) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[0]->statusword = 0x0218;
  gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.arm.fault().code, 0x0218u);
  gantry.nodes[0]->send(0x081, {0x20, 0x23, 0x02, 0, 0, 0, 0, 0});
  gantry.cycle(ArmRequest::kQuickStop);
  EXPECT_EQ(gantry.arm.fault().code, 0x2320u);
}

TEST(CanopenArm, EmergencyOfAWarningOnlyCounts) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[0]->send(0x081, {0x20, 0x81, 0x10, 0, 0, 0, 0, 0});  // error passive
  gantry.nodes[0]->send(0x081, {0x00, 0x00, 0x00, 0, 0, 0, 0, 0});  // over
  gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.arm.state(), ArmState::kEnabled);
  EXPECT_EQ(gantry.arm.counters().emergencies, 2u);
}

TEST(CanopenArm, LostHeartbeatIsNoticedAfterTheRobotsTimeout) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[1]->heartbeats = false;
  int cycles = 0;
  while (gantry.arm.state() == ArmState::kEnabled && cycles < 400) {
    gantry.cycle(ArmRequest::kEnabled, gantry.feedback.position);
    ++cycles;
  }
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kHeartbeatLost);
  EXPECT_EQ(gantry.arm.fault().node, 2);
  // The last one was at most 100 ms old: 200 to 300 ms, two to a cycle.
  EXPECT_GE(cycles, 100);
  EXPECT_LE(cycles, 151);
}

TEST(CanopenArm, BootUpOfARunningNodeIsAFault) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[3]->reboot();
  gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kUnexpectedReset);
  EXPECT_EQ(gantry.arm.fault().node, 4);
  EXPECT_NE(describe(gantry.arm.fault(), gantry.robot).find("force/torque sensor"),
            std::string::npos);
}

TEST(CanopenArm, NodeThatLeavesOperationalIsAFault) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[0]->send(0x701, {0x04});
  gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kUnexpectedReset);
  EXPECT_EQ(gantry.arm.fault().code, 4u);
}

TEST(CanopenArm, FiveMissingFeedbacksAreBorneTheSixthIsNot) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[0]->answers_sync = false;
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(gantry.cycle(ArmRequest::kEnabled));
  EXPECT_EQ(gantry.arm.state(), ArmState::kEnabled);
  gantry.nodes[0]->answers_sync = true;
  gantry.cycle(ArmRequest::kEnabled);
  gantry.nodes[0]->answers_sync = false;
  for (int i = 0; i < 6; ++i) gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kFeedbackMissing);
  EXPECT_EQ(gantry.arm.fault().node, 1);
  EXPECT_EQ(gantry.arm.counters().joint_frames_missing, 11u);
}

TEST(CanopenArm, ShortFeedbackIsDroppedAndCounted) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[0]->tpdo_bytes = 7;
  EXPECT_FALSE(gantry.cycle(ArmRequest::kEnabled));
  EXPECT_EQ(gantry.feedback.joints_fresh, 6u);
  EXPECT_EQ(gantry.arm.counters().malformed_frames, 1u);
}

TEST(CanopenArm, TornWrenchIsNeverPublished) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[3]->tears = true;
  gantry.nodes[3]->wrench_counts = {1, 2, 3, 4, 5, 6};
  EXPECT_TRUE(gantry.cycle(ArmRequest::kEnabled)) << "both halves came";
  EXPECT_FALSE(gantry.feedback.wrench_fresh);
  EXPECT_EQ(gantry.feedback.wrench, Vector6::Zero());
  EXPECT_EQ(gantry.arm.counters().wrench_halves_torn, 1u);
  for (int i = 0; i < 5; ++i) gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kSensorStale);
}

TEST(CanopenArm, RepeatedSampleIsNotFresh) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[3]->samples_per_sync = 0;
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(gantry.arm.state(), ArmState::kEnabled);
    gantry.cycle(ArmRequest::kEnabled);
    EXPECT_FALSE(gantry.feedback.wrench_fresh);
  }
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kSensorStale);
}

//  cycle      1  2  3  4  5  6
//  wrench     -  -  x  -  -  x       m = 3: all of these cycles are complete
TEST(CanopenArm, ASensorSlowerThanTheCycleIsHeardInEveryThirdAndNamedAfterFiveMissingSamples) {
  Robot robot = gantry_robot();
  robot.sensor.cycles_per_sample = 3;
  GantryOnBus gantry(robot);
  ASSERT_TRUE(gantry.prepare_and_enable());
  int fresh = 0;
  for (int i = 0; i < 30; ++i) {
    EXPECT_TRUE(gantry.cycle(ArmRequest::kEnabled));
    fresh += gantry.feedback.wrench_fresh ? 1 : 0;
  }
  EXPECT_EQ(fresh, 10);
  EXPECT_EQ(gantry.arm.counters().wrenches_missing, 0u);
  while (!gantry.feedback.wrench_fresh) gantry.cycle(ArmRequest::kEnabled);
  gantry.nodes[3]->answers_sync = false;
  for (int i = 0; i < 15; ++i) EXPECT_EQ(gantry.cycle(ArmRequest::kEnabled), i < 2) << i;
  EXPECT_EQ(gantry.arm.state(), ArmState::kEnabled);
  EXPECT_EQ(gantry.arm.counters().wrenches_missing, 5u);
  gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kSensorStale);
  EXPECT_EQ(describe(gantry.arm.fault(), gantry.robot),
            "node 4 (force/torque sensor): no new wrench in 16 cycles in a row, at most 15 are "
            "allowed; check that the sensor samples at least once in 3 cycles of 2000 us");
}

TEST(CanopenArm, SaturatedWrenchIsAFaultNotAValue) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[3]->wrench_counts[2] = -30000;  // -300 N
  gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kSensorInvalid);
  EXPECT_EQ(describe(gantry.arm.fault(), gantry.robot),
            "node 4 (force/torque sensor): fz = -300.00 N is at or beyond the range of 300.00; the "
            "load is too high or the sensor is damaged");
}

TEST(CanopenArm, LateFeedbackIsNotTakenForThisCycles) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare());
  gantry.arm.start_cycle(gantry.now_ns);
  EXPECT_FALSE(gantry.arm.receive(gantry.now_ns, gantry.feedback));
  gantry.arm.command(gantry.now_ns, ArmRequest::kDisabled, {});
  gantry.step_nodes();  // answers come after the cycle has closed
  gantry.now_ns += 2'000'000;
  gantry.arm.start_cycle(gantry.now_ns);
  EXPECT_FALSE(gantry.arm.receive(gantry.now_ns, gantry.feedback));
  EXPECT_EQ(gantry.feedback.joints_fresh, 0u);
  EXPECT_EQ(gantry.arm.counters().late_frames, 5u);
  gantry.step_nodes();
  EXPECT_TRUE(gantry.arm.receive(gantry.now_ns, gantry.feedback));
}

TEST(CanopenArm, SetpointThatIsNoNumberStopsTheDrivesInItsOwnCycle) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.cycle(ArmRequest::kEnabled, {0.25, 0.0, 0.0});
  gantry.cycle(ArmRequest::kEnabled, {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
  gantry.step_nodes();
  // Quick stop, to where the joint is.
  EXPECT_EQ(last_command(gantry, 0), (Bytes{0x02, 0x00, 0x90, 0xD0, 0x03, 0x00}));
  EXPECT_EQ(gantry.arm.counters().invalid_setpoints, 1u);
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kSetpointNotFinite);
  EXPECT_EQ(gantry.arm.fault().node, 1);
}

TEST(CanopenArm, BusThatGoesDownIsAFaultAndPrepareRecovers) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.bus.set_up(false);
  gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kBusDown);
  gantry.bus.set_up(true);
  EXPECT_TRUE(gantry.prepare_and_enable());
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kNone);
}

TEST(CanopenArm, BusOffIsAFault) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.bus.set_bus_off(0, true);
  gantry.cycle(ArmRequest::kEnabled);
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kBusOff);
}

}  // namespace
}  // namespace tenon::hw
