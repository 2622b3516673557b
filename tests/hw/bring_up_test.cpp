// Bring-up against scripted nodes: what is written in which order, and how each failure is named.

#include "hw/arm/bring_up.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hw/arm/describe_fault.h"
#include "hw/arm/node_settings.h"
#include "shared/canopen/robot_drives.h"
#include "tests/hw/gantry_on_bus.h"
#include "tests/support/frame_filter.h"
#include "tests/support/refusal.h"

namespace tenon::hw {
namespace {

TEST(BringUp, WritesTheDriveThisConfigurationInThisOrder) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare()) << describe(gantry.arm.fault(), gantry.robot);
  using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  Pairs written;
  for (const auto& write : gantry.nodes[1]->writes) written.emplace_back(write.object, write.value);
  const Pairs expected{
      {0x101700, 100},         // heartbeat every 100 ms
      {0x100600, 2000},        // SYNC period, us
      {0x60C201, 2},           // 2 * 10^-3 s
      {0x60C202, 0xFD},        // -3
      {0x606000, 8},           // cyclic synchronous position
      {0x101601, 0x007F012C},  // watch node 127 for 300 ms
      {0x600700, 3},           // then quick stop
      {0x605A00, 2},           // quick stop: ramp down, then disable
      {0x605B00, 1},          {0x605C00, 1},          {0x608500, 10'000'000},  // 10 m/s^2
      {0x606500, 5000},                                                        // 5 mm
      {0x606600, 10},                                                          // 10 ms
      {0x140001, 0x80000202}, {0x140002, 1},          {0x160000, 0},
      {0x160001, 0x60400010}, {0x160002, 0x607A0020}, {0x160000, 2},
      {0x140001, 0x00000202}, {0x140005, 300},  // setpoints are missed after 300 ms
      {0x140101, 0x80000183}, {0x140102, 255},  // the stop of all drives
      {0x160100, 0},          {0x160101, 0x60400010}, {0x160100, 1},
      {0x140101, 0x00000183}, {0x180001, 0xC0000191}, {0x180002, 1},
      {0x1A0000, 0},          {0x1A0001, 0x60410010}, {0x1A0002, 0x60770010},
      {0x1A0003, 0x60640020}, {0x1A0000, 3},          {0x180001, 0x40000191},
      {0x180101, 0xC0000282},  // the second TPDO that it had on
  };
  EXPECT_EQ(written, expected);
}

TEST(BringUp, ADriveThatWatchesNoSetpointsComesUpWithoutItsWatchSettled) {
  GantryOnBus gantry;
  gantry.nodes[1]->refuses[0x140005] = 0x06090011U;
  gantry.nodes[2]->read_only.insert(0x140005);
  EXPECT_TRUE(gantry.prepare()) << describe(gantry.arm.fault(), gantry.robot);
  EXPECT_EQ(gantry.nodes[0]->objects[0x140005].value, 300U);
}

TEST(BringUp, GivesTheSensorTheHighestPriority) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare());
  auto& objects = gantry.nodes[3]->objects;
  EXPECT_EQ(objects[0x180001].value, 0x40000181u);
  EXPECT_EQ(objects[0x180101].value, 0x40000182u);
  EXPECT_EQ(objects[0x1A0001].value, 0x64010110u);
  EXPECT_EQ(objects[0x1A0004].value, 0x20010010u);
  EXPECT_EQ(objects[0x1A0103].value, 0x64010610u);
  EXPECT_EQ(objects[0x1A0100].value, 4u);
  EXPECT_EQ(objects[0x180002].value, 1u);
}

TEST(BringUp, ASlowSensorIsAskedByEveryThirdSync) {
  Robot robot = gantry_robot();
  robot.sensor.cycles_per_sample = 3;
  GantryOnBus gantry(robot);
  ASSERT_TRUE(gantry.prepare());
  EXPECT_EQ(gantry.nodes[3]->objects[0x180002].value, 3u);
  EXPECT_EQ(gantry.nodes[3]->objects[0x180102].value, 3u);
  EXPECT_EQ(gantry.nodes[0]->objects[0x180002].value, 1u);
}

TEST(BringUp, EveryNmtTransitionLeavesAndIsConfirmed) {
  GantryOnBus gantry;
  std::vector<std::string> seen;
  const tests::FrameFilter filter(gantry.bus, [&](CanFrame& frame, std::size_t) {
    const std::string node = std::to_string(frame.data[1]);
    if (frame.id == 0) seen.push_back("nmt " + std::to_string(frame.data[0]) + " to " + node);
    if (frame.id == 0x703) seen.push_back("node 3 is " + std::to_string(frame.data[0]));
    return true;
  });
  ASSERT_TRUE(gantry.prepare());
  const auto position = [&](const std::string& what) {
    const auto found = std::find(seen.begin(), seen.end(), what);
    EXPECT_NE(found, seen.end()) << what;
    return found - seen.begin();
  };
  EXPECT_LT(position("nmt 130 to 3"), position("node 3 is 0"));
  EXPECT_LT(position("node 3 is 0"), position("nmt 128 to 3"));
  EXPECT_LT(position("nmt 128 to 3"), position("node 3 is 127"));
  EXPECT_LT(position("node 3 is 127"), position("nmt 1 to 3"));
  EXPECT_LT(position("nmt 1 to 3"), position("node 3 is 5"));
  ASSERT_EQ(gantry.arm.bring_up().identities().size(), 4u);
  EXPECT_EQ(gantry.arm.bring_up().identities()[3].device_type, 0x194u);
  EXPECT_EQ(gantry.arm.bring_up().identities()[0].vendor, 0xABCDu);
}

TEST(BringUp, NodeThatDoesNotAnswerIsNamedWithWhatWasExpected) {
  GantryOnBus gantry;
  gantry.nodes[2]->dead = true;
  const std::int64_t start_ns = gantry.now_ns;
  EXPECT_EQ(gantry.refused(),
            "node 3 (z): no boot-up within 1.0 s, nor within as long after a second NMT reset; "
            "expected 0x703; check power, wiring, bit rate, node id, and boot_s of its drive's "
            "profile");
  EXPECT_EQ(gantry.now_ns - start_ns, 2'300'000'000);  // of which it listens 0.3 s
}

TEST(BringUp, NodeThatWakesLateIsResetOnceMore) {
  GantryOnBus gantry;
  gantry.nodes[2]->dead = true;
  EXPECT_FALSE(gantry.prepare(1100));
  gantry.nodes[2]->dead = false;
  EXPECT_TRUE(gantry.prepare());
}

TEST(BringUp, RefusedObjectIsNamedWithItsAbort) {
  GantryOnBus gantry;
  gantry.nodes[0]->refuses[0x60C201] = 0x06090030;
  EXPECT_EQ(gantry.refused(),
            "node 1 (x): refused 60C2h:1 = 0x2: value out of range (abort 0x06090030); check the "
            "device's manual and firmware, and the profile of its drive");
}

// As an LWA 4P has them: mapped for interpolated position, and nobody can change that.
void fix_mapping(ScriptedNode& node, std::uint32_t target) {
  node.default_mapping = {{0x160000, 2},         {0x160001, 0x60400010}, {0x160002, target},
                          {0x1A0000, 3},         {0x1A0001, 0x60410010}, {0x1A0002, 0x60770010},
                          {0x1A0003, 0x60640020}};
  for (const auto& [object, value] : node.default_mapping) node.read_only.insert(object);
}

TEST(BringUp, AFixedMappingThatIsTheOneWantedIsTakenAsItIs) {
  Robot robot = gantry_robot();
  canopen_drive(robot.joints[0]).mode = DriveMode::kInterpolatedPosition;
  GantryOnBus gantry(robot);
  gantry.nodes[0]->keeps[0x650200] = 0x43;
  fix_mapping(*gantry.nodes[0], 0x60C10120);
  ASSERT_TRUE(gantry.prepare_and_enable()) << describe(gantry.arm.fault(), gantry.robot);
  std::vector<std::uint32_t> pdos;
  for (const auto& write : gantry.nodes[0]->writes) {
    if (write.object >> 8 >= 0x1400 && write.object >> 8 < 0x1C00) pdos.push_back(write.object);
  }
  EXPECT_EQ(pdos, (std::vector<std::uint32_t>{0x140001, 0x140002, 0x140001, 0x140005, 0x140101,
                                              0x140102, 0x160100, 0x160101, 0x160100, 0x140101,
                                              0x180001, 0x180002, 0x180001, 0x180101}));
  JointVector target = gantry.feedback.position;
  target[0] += 0.001;
  for (int i = 0; i < 3; ++i) gantry.cycle(ArmRequest::kEnabled, target);
  EXPECT_EQ(gantry.nodes[0]->target_counts, 1000);
}

TEST(BringUp, AFixedMappingThatIsAnotherIsNamed) {
  GantryOnBus gantry;
  fix_mapping(*gantry.nodes[0], 0x60C10120);  // where mode 8 needs 607Ah
  EXPECT_EQ(gantry.refused(),
            "node 1 (x): its PDO mapping 1600h is fixed (abort 0x06010002) and another than "
            "hw/PROTOCOL.md lists; a joint's depends on mode and targets_per_frame");
}

TEST(BringUp, AConstantThatIsNoMappingIsNotCalledOne) {
  GantryOnBus gantry;
  gantry.nodes[0]->objects[0x100500] = {4, 0x40000080};
  gantry.nodes[0]->read_only.insert(0x100500);
  EXPECT_EQ(gantry.refused(),
            "node 1 (x): refused 1005h:0 = 0x80: object is read-only (abort 0x06010002); check the "
            "device's manual and firmware, and the profile of its drive");
}

// What it refuses of that is left switched off: half a mapping would be none.
TEST(BringUp, ADriveWithoutAnRpdoForTheStopIsBroughtUpWithoutItAndNamed) {
  for (const std::uint32_t object : {0x140101U, 0x160100U, 0x160101U}) {
    GantryOnBus gantry;
    gantry.nodes[1]->refuses[object] = object == 0x140101U ? 0x06020000U : 0x06010002U;
    ASSERT_TRUE(gantry.prepare_and_enable()) << describe(gantry.arm.fault(), gantry.robot);
    std::vector<SettingNote> notes = gantry.arm.bring_up().notes();
    std::erase_if(notes, [](const auto& n) { return n.kind != SettingNote::Kind::kNoStop; });
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_EQ(describe(notes.front(), gantry.robot),
              "node 2 (y): has no free RPDO by which all drives are stopped at once: beyond "
              "force_fault_N it stops with the next SYNC, up to 2 ms after the others");
    EXPECT_NE(gantry.nodes[1]->objects[0x140101].value & 0x80000000U, 0U);
    EXPECT_EQ(gantry.nodes[0]->objects[0x140101].value, 0x183U);
  }
}

TEST(BringUp, ValueThatIsNotKeptIsNoticedOnReadBack) {
  GantryOnBus gantry;
  gantry.nodes[1]->keeps[0x606500] = 0;
  EXPECT_EQ(gantry.refused(),
            "node 2 (y): holds 6065h:0 = 0x0 where 0x1388 was asked for; check the device's "
            "limits and firmware");
}

TEST(BringUp, DriveWithoutTheModeIsRefused) {
  GantryOnBus gantry;
  gantry.nodes[0]->keeps[0x650200] = 0x43;
  EXPECT_EQ(gantry.refused(),
            "node 1 (x): does not support the robot file's mode of operation (6502h = 0x43, bit "
            "mask 0x80 is missing); set the joint's mode to 8 or 7 as the drive offers");
}

TEST(BringUp, ModeThatIsNeverDisplayedEndsAfterHalfASecond) {
  GantryOnBus gantry;
  gantry.nodes[0]->keeps[0x606100] = 0;
  const std::int64_t start_ns = gantry.now_ns;
  EXPECT_EQ(gantry.refused(),
            "node 1 (x): holds 6061h:0 = 0x0 where 0x8 was asked for; check the device's limits "
            "and firmware");
  EXPECT_GE(gantry.now_ns - start_ns, 500'000'000);
}

TEST(BringUp, SomethingElseThanADriveIsRefused) {
  GantryOnBus gantry;
  gantry.nodes[0]->keeps[0x100000] = 0x00000191;
  EXPECT_NE(gantry.refused().find("is no CiA 402 drive"), std::string::npos);
}

TEST(BringUp, SdoWithoutAnswerIsNamed) {
  GantryOnBus gantry;
  gantry.nodes[3]->mute_at = 0x1A0102;
  EXPECT_EQ(gantry.refused(),
            "node 4 (force/torque sensor): no SDO answer for 1A01h:2 within 0.5 s; expected "
            "0x584; check that no other master talks to the node");
}

TEST(BringUp, SensorThatReportsAFaultIsRefused) {
  GantryOnBus gantry;
  gantry.nodes[3]->keeps[0x200200] = 2;
  EXPECT_EQ(gantry.refused(),
            "node 4 (force/torque sensor): reports status 0x0002 (2002h) where 0 is good; check "
            "the sensor");
}

TEST(BringUp, NodeThatDoesNotStartIsNamed) {
  GantryOnBus gantry;
  gantry.nodes[1]->ignores_start = true;
  EXPECT_EQ(gantry.refused(),
            "node 2 (y): did not become operational within 1.0 s; expected 0x702#05; check the "
            "node's error register (1001h)");
}

TEST(BringUp, NodeThatResetsDuringConfigurationIsNamed) {
  GantryOnBus gantry;
  while (gantry.nodes[2]->writes.size() < 5) EXPECT_FALSE(gantry.prepare(1));
  gantry.nodes[0]->reboot();
  EXPECT_NE(gantry.refused().find("node 1 (x): has reset itself while running"), std::string::npos);
}

/// What a second master on the bus of a first says, which must not notice.
std::string second_master(GantryOnBus& gantry) {
  CanopenArm second(gantry.robot, gantry.bus.attach());
  for (int i = 0; i < 500 && second.state() != ArmState::kFault; ++i) {
    EXPECT_FALSE(second.prepare(gantry.now_ns));
    gantry.cycle(ArmRequest::kEnabled, gantry.feedback.position);
  }
  EXPECT_EQ(second.state(), ArmState::kFault);
  return describe(second.fault(), gantry.robot);
}

TEST(BringUp, ListensFirstAndLeavesTheArmOfAnotherMasterAlone) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  EXPECT_EQ(second_master(gantry),
            "another master runs on this bus: 0x080 (SYNC) came from it; stop it first");
  for (int i = 0; i < 10; ++i) gantry.cycle(ArmRequest::kEnabled, gantry.feedback.position);
  EXPECT_EQ(gantry.arm.state(), ArmState::kEnabled);
  EXPECT_EQ(gantry.nodes[0]->statusword, 0x0237);
}

TEST(BringUp, AMasterWithoutSyncIsKnownByItsHeartbeat) {
  GantryOnBus gantry;
  EXPECT_FALSE(gantry.prepare(100));
  CanFrame heartbeat;
  heartbeat.id = 0x77F;
  heartbeat.length = 1;
  heartbeat.data[0] = 0x05;
  (void)gantry.bus.attach().send(heartbeat);
  EXPECT_EQ(gantry.refused(),
            "another master runs on this bus: 0x77F (heartbeat of the master's node) came from it; "
            "stop it first");
}

TEST(BringUp, NothingLeavesWhileItListens) {
  GantryOnBus gantry;
  int frames = 0;
  const tests::FrameFilter filter(gantry.bus, [&](CanFrame&, std::size_t) {
    ++frames;
    return true;
  });
  EXPECT_FALSE(gantry.prepare(300));
  EXPECT_EQ(frames, 0);
  EXPECT_FALSE(gantry.prepare(2));
  EXPECT_GE(frames, 4);
}

TEST(BringUp, DeadBusIsNamed) {
  GantryOnBus gantry;
  gantry.bus.set_up(false);
  EXPECT_EQ(gantry.arm.prepare(gantry.now_ns), false);
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kBusDown);
}

TEST(BringUp, PrepareStartsOverAfterAFault) {
  GantryOnBus gantry;
  gantry.nodes[2]->dead = true;
  EXPECT_FALSE(gantry.prepare());
  gantry.nodes[2]->dead = false;
  EXPECT_TRUE(gantry.prepare());
  EXPECT_EQ(gantry.arm.state(), ArmState::kDisabled);
}

std::string robot_refusal(const Robot& robot) {
  return tests::refusal([&] { check_robot(robot); });
}

TEST(CheckRobot, RefusesWhatCannotBeDriven) {
  EXPECT_EQ(robot_refusal(gantry_robot()), "accepted");
  Robot robot = gantry_robot();
  robot.joints[1].node = 4;
  EXPECT_EQ(robot_refusal(robot),
            "robot 'gantry': node 4 is given to both joint y and the force/torque sensor; every "
            "node needs its own");
  robot = gantry_robot();
  robot.cycle_us = 2'000'001;
  EXPECT_NE(robot_refusal(robot).find("60C2h"), std::string::npos);
  robot = gantry_robot();
  robot.joints[0].counts_per_unit = 0.0;
  EXPECT_NE(robot_refusal(robot).find("joint x: |counts per unit| = 0"), std::string::npos);
  robot = gantry_robot();
  robot.joints[0].counts_per_unit = 1e10;
  EXPECT_NE(robot_refusal(robot).find("must fit 32 bits"), std::string::npos);
  robot = gantry_robot();
  robot.heartbeat_timeout_ms = 150;
  EXPECT_NE(robot_refusal(robot).find("at least twice"), std::string::npos);
  robot = gantry_robot();
  robot.joints.clear();
  EXPECT_NE(robot_refusal(robot).find("0 joints"), std::string::npos);
}

TEST(InterpolationPeriod, IsExactOrNothing) {
  EXPECT_EQ(interpolation_period(2000)->value, 2);
  EXPECT_EQ(interpolation_period(2000)->exponent, -3);
  EXPECT_EQ(interpolation_period(2500)->value, 25);
  EXPECT_EQ(interpolation_period(2500)->exponent, -4);
  EXPECT_EQ(interpolation_period(250)->value, 25);
  EXPECT_EQ(interpolation_period(250)->exponent, -5);
  EXPECT_FALSE(interpolation_period(2001));
  EXPECT_FALSE(interpolation_period(256'000));
}

}  // namespace
}  // namespace tenon::hw
