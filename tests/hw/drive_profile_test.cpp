// Bring-up by a drive's profile, against scripted nodes: what is written, what is left alone, what
// is said, and how each refusal is named.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hw/arm/cob_ids.h"
#include "hw/arm/describe_fault.h"
#include "hw/arm/drive_settings.h"
#include "hw/arm/node_settings.h"
#include "shared/canopen/robot_drives.h"
#include "shared/config/drive_file.h"
#include "shared/config/files.h"
#include "shared/config/load.h"
#include "tests/hw/gantry_on_bus.h"
#include "tests/support/frame_filter.h"
#include "tests/support/places.h"
#include "tests/support/refusal.h"

namespace tenon::hw {
namespace {

DriveProfile shipped(const std::string& name) {
  return load_drive(tests::in_tree("hw/drives/" + name + ".yaml"));
}

Robot robot_with(const DriveProfile& drive) {
  Robot robot = gantry_robot();
  for (Joint& joint : robot.joints) canopen_drive(joint).profile = drive;
  return robot;
}

bool wrote(const ScriptedNode& node, std::uint32_t object) {
  return std::any_of(node.writes.begin(), node.writes.end(),
                     [&](const ScriptedNode::Write& write) { return write.object == object; });
}

std::vector<std::string> notes(const GantryOnBus& gantry, std::uint8_t node) {
  std::vector<std::string> lines;
  for (const SettingNote& note : gantry.arm.bring_up().notes()) {
    if (note.node == node) lines.push_back(describe(note, gantry.robot));
  }
  return lines;
}

TEST(DriveProfile, ByTheBookIsWhatItsFileSpellsOut) {
  EXPECT_EQ(shipped("cia402"), DriveProfile{});
  EXPECT_TRUE(drive_remarks(gantry_robot()).empty()) << drive_remarks(gantry_robot()).front();
}

TEST(DriveProfile, TheProtocolListsEveryObjectThatItTellsOf) {
  const std::string text = config::read_file(tests::in_tree("hw/PROTOCOL.md"));
  for (const DriveObjectRow& row : kDriveObjectRows) {
    const std::string start = "\n| " + std::string(row.key) + " ";
    const std::size_t at = text.find(start);
    ASSERT_NE(at, std::string::npos) << row.key;
    const std::string line = text.substr(at + 1, text.find('\n', at + 1) - at);
    const char* presence = row.presence == Presence::kRequired ? "| required, " : "| optional, ";
    EXPECT_NE(line.find(presence), std::string::npos) << line;
    EXPECT_NE(line.find(row.size_bytes == 1   ? "8 |"
                        : row.size_bytes == 2 ? "16 |"
                                              : "32 |"),
              std::string::npos)
        << line;
  }
}

TEST(DriveProfile, WhatAProfileCallsAbsentIsNeverAskedFor) {
  const DriveProfile lwa = shipped("schunk_lwa4p");
  Robot robot = robot_with(lwa);
  for (Joint& joint : robot.joints) canopen_drive(joint).mode = DriveMode::kInterpolatedPosition;
  GantryOnBus gantry(robot);
  const std::vector<std::uint32_t> lacking = {0x100600, 0x600700, 0x605A00, 0x605B00,
                                              0x605C00, 0x606600, 0x607200, 0x608500};
  std::vector<std::uint32_t> asked;
  const tests::FrameFilter filter(gantry.bus, [&](CanFrame& frame, std::size_t) {
    const std::uint32_t object = frame.data[2] * 0x10000u | frame.data[1] * 0x100u | frame.data[3];
    const bool request = frame.id >= 0x601 && frame.id <= 0x603;
    if (request && std::find(lacking.begin(), lacking.end(), object) != lacking.end()) {
      asked.push_back(object);
    }
    return true;
  });
  for (int i = 0; i < 3; ++i) {
    ScriptedNode& node = *gantry.nodes[static_cast<std::size_t>(i)];
    node.keeps[0x650200] = 0x43;
    node.objects[0x607D01] = node.objects[0x607D02] = {4, 0};
  }
  ASSERT_TRUE(gantry.prepare_and_enable()) << describe(gantry.arm.fault(), gantry.robot);
  EXPECT_TRUE(asked.empty()) << std::hex << asked.front();
  // -1 m and 1 m at 10^6 counts to the metre.
  EXPECT_EQ(gantry.nodes[0]->objects[0x607D01].value, 0xFFF0BDC0u);
  EXPECT_EQ(gantry.nodes[0]->objects[0x607D02].value, 1'000'000u);
}

TEST(DriveProfile, WhatCannotBeSetIsSaidWithWhatTheCellMustProvide) {
  const auto lines = drive_remarks(load_robot(tests::in_tree("hw/robots/lwa4p/robot.yaml")));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0],
            "joints arm_1, arm_2, arm_3, arm_4, arm_5, arm_6 (drive schunk_lwa4p): nothing makes "
            "them stop when the executor or the bus dies (1016h, 6007h): they may go on under "
            "power; the cell must cut their power by a stop of its own");
  EXPECT_NE(lines[1].find("605Ah"), std::string::npos);
  EXPECT_NE(lines[2].find("6085h"), std::string::npos);
}

TEST(DriveProfile, AClampedWindowIsTakenAndTold) {
  GantryOnBus gantry;
  gantry.nodes[1]->keeps[0x606500] = 2000;
  ASSERT_TRUE(gantry.prepare_and_enable()) << describe(gantry.arm.fault(), gantry.robot);
  EXPECT_EQ(notes(gantry, 2),
            (std::vector<std::string>{"node 2 (y): 6065h:0 holds 0x7D0 (2000) where 0x1388 (5000) "
                                      "was written; taken as it is",
                                      "node 2 (y): 6072h:0 does not exist; its profile allows that",
                                      "node 2 (y): 607Dh:1 does not exist; its profile allows that",
                                      "node 2 (y): 607Dh:2 does not exist; its profile allows "
                                      "that"}));
}

TEST(DriveProfile, AWindowThatTheDriveRefusesIsTakenUnlessItIsOff) {
  GantryOnBus gantry;
  gantry.nodes[1]->refuses[0x606500] = 0x06090031;
  EXPECT_EQ(gantry.refused(6000),
            "node 2 (y): refused 6065h:0 = 0x1388: value too high (abort 0x06090031); check the "
            "device's manual and firmware, and the profile of its drive");
}

TEST(DriveProfile, ALimitOfTorqueIsWrittenWhereTheDriveHasOne) {
  GantryOnBus gantry;
  gantry.nodes[2]->objects[0x607200] = {2, 0};
  ASSERT_TRUE(gantry.prepare());
  EXPECT_EQ(gantry.nodes[2]->objects[0x607200].value, 2000u);  // 400 N of 200 N rated
}

TEST(DriveProfile, SyncIdentifierAndCounterAreSetWhereTheyAreOther) {
  GantryOnBus gantry;
  gantry.nodes[0]->objects[0x100500] = {4, 0x85};
  gantry.nodes[0]->objects[0x101900] = {1, 10};
  gantry.nodes[1]->objects[0x100500] = {4, 0x80};
  gantry.nodes[1]->objects[0x101900] = {1, 0};
  ASSERT_TRUE(gantry.prepare());
  EXPECT_EQ(gantry.nodes[0]->objects[0x100500].value, 0x80u);
  EXPECT_EQ(gantry.nodes[0]->objects[0x101900].value, 0u);
  EXPECT_FALSE(wrote(*gantry.nodes[1], 0x100500));
  EXPECT_FALSE(wrote(*gantry.nodes[1], 0x101900));
  // The counter changes only while the period is 0, which then is the cycle again.
  std::vector<std::uint32_t> periods;
  for (const auto& write : gantry.nodes[0]->writes) {
    if (write.object == 0x100600) periods.push_back(write.value);
  }
  EXPECT_EQ(periods, (std::vector<std::uint32_t>{0, 2000}));
}

TEST(DriveProfile, AnAcceptedValueIsReadAndNeverWritten) {
  const DriveProfile epos = shipped("maxon_epos4");
  GantryOnBus gantry(robot_with(epos));
  for (std::size_t i = 0; i < 3; ++i) {
    ScriptedNode& node = *gantry.nodes[i];
    node.objects[0x100500] = {4, 0x80};
    node.objects[0x607D01] = node.objects[0x607D02] = {4, 0};
    node.read_only.insert({0x606600, 0x100500});
  }
  ASSERT_TRUE(gantry.prepare_and_enable()) << describe(gantry.arm.fault(), gantry.robot);
  EXPECT_FALSE(wrote(*gantry.nodes[0], 0x606600));
  const auto lines = notes(gantry, 1);
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.back(), "node 1 (x): 6066h:0 = 0x0 (0), left as it is (by the book 0xA)");
}

TEST(DriveProfile, AnObjectOfTheDevicesOwnIsWrittenBeforeTheMode) {
  DriveProfile drive;
  drive.extra.push_back({0x2010, 1, 2, 7, {}});
  GantryOnBus gantry(robot_with(drive));
  for (std::size_t i = 0; i < 3; ++i) gantry.nodes[i]->objects[0x201001] = {2, 0};
  ASSERT_TRUE(gantry.prepare());
  ASSERT_GT(gantry.nodes[0]->writes.size(), 2u);
  EXPECT_EQ(gantry.nodes[0]->writes[1].object, 0x201001u);
  EXPECT_EQ(gantry.nodes[0]->writes[1].value, 7u);
}

TEST(DriveProfile, FixedPdosAreComparedAndNeverWritten) {
  DriveProfile drive;
  drive.fixed_mapping = drive.fixed_identifiers = drive.fixed_transmission_types = true;
  Robot robot = gantry_robot();
  canopen_drive(robot.joints[2]).profile = drive;
  robot.joints[2].node = 7;
  GantryOnBus gantry(robot);
  ScriptedNode& node = *gantry.nodes[2];
  node.default_mapping = {{0x160000, 2},          {0x160001, 0x60400010}, {0x160002, 0x607A0020},
                          {0x1A0000, 3},          {0x1A0001, 0x60410010}, {0x1A0002, 0x60770010},
                          {0x1A0003, 0x60640020}, {0x180002, 1}};
  ASSERT_TRUE(gantry.prepare_and_enable()) << describe(gantry.arm.fault(), gantry.robot);
  for (const auto& write : node.writes) {
    EXPECT_FALSE(write.object >> 8 >= 0x1400 && write.object >> 8 < 0x1C00) << write.object;
  }
  JointVector target = gantry.feedback.position;
  target[2] += 0.002;
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(gantry.cycle(ArmRequest::kEnabled, target));
  EXPECT_EQ(node.target_counts, 2000);
  EXPECT_EQ(joint_feedback_cob_id(robot, 2), 0x187u);
  // At node 3 it would answer where the stop of all drives is heard.
  robot.joints[2].node = 3;
  EXPECT_THROW(GantryOnBus{robot}, InputError);
}

TEST(DriveProfile, AFixedTransmissionTypeThatIsNotOfSyncIsNamed) {
  DriveProfile drive;
  drive.fixed_transmission_types = true;
  Robot robot = gantry_robot();
  canopen_drive(robot.joints[0]).profile = drive;
  GantryOnBus gantry(robot);
  EXPECT_EQ(gantry.refused(6000),
            "node 1 (x): holds 1800h:2 = 0xFF where 0x1 was asked for; check the device's limits "
            "and firmware");
}

TEST(DriveProfile, FixedIdentifiersThatMeetTheForceFramesAreRefused) {
  Robot robot = gantry_robot();
  canopen_drive(robot.joints[0]).profile.fixed_identifiers = true;
  EXPECT_EQ(tests::refusal([&] { check_robot(robot); }),
            "robot 'gantry': joint x: its feedback stays at 181h, which another frame has (drive "
            "cia402 has fixed identifiers); give it another node than 1");
  robot.targets_per_frame = 2;
  EXPECT_NE(tests::refusal([&] { check_robot(robot); }).find("targets_per_frame: 1"),
            std::string::npos);
}

// reset                      boot-up
//   |--------- 0.8 s ----------|
TEST(DriveProfile, ABootOfFourFifthsOfASecondIsResetOnce) {
  GantryOnBus gantry;
  int resets = 0;
  std::int64_t reset_ns = 0;
  const tests::FrameFilter filter(gantry.bus, [&](CanFrame& frame, std::size_t) {
    const bool of_node = frame.id == 0 && frame.data[0] == 0x82 && frame.data[1] == 3;
    resets += of_node ? 1 : 0;
    if (of_node) reset_ns = gantry.now_ns;
    return !of_node;  // the node hears nothing: it boots by itself below
  });
  while (resets == 0 || gantry.now_ns - reset_ns < 800'000'000) {
    ASSERT_FALSE(gantry.prepare(1));
    ASSERT_NE(gantry.arm.state(), ArmState::kFault);
  }
  gantry.nodes[2]->reboot();
  ASSERT_TRUE(gantry.prepare_and_enable()) << describe(gantry.arm.fault(), gantry.robot);
  EXPECT_EQ(resets, 1);
}

TEST(DriveProfile, ABootThatTakesAsLongAsItsProfileSaysIsAwaited) {
  Robot robot = gantry_robot();
  canopen_drive(robot.joints[2]).profile.boot_s = 2.0;
  GantryOnBus gantry(robot);
  gantry.nodes[2]->dead = true;
  const std::int64_t start_ns = gantry.now_ns;
  EXPECT_NE(gantry.refused(6000).find("node 3 (z): no boot-up within 2.0 s"), std::string::npos);
  EXPECT_EQ(gantry.now_ns - start_ns, 4'300'000'000);
}

TEST(DriveProfile, AnEmergencyThatWarnsEndsNothingWhileTheStatuswordIsWell) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[2]->send(0x083, {0x10, 0x42, 0x08, 0, 0, 0, 0, 0});
  gantry.nodes[1]->send(0x082, {0x11, 0xFF, 0x80, 0, 0, 0, 0, 0});
  for (int i = 0; i < 20; ++i) gantry.cycle(ArmRequest::kEnabled, gantry.feedback.position);
  EXPECT_EQ(gantry.arm.state(), ArmState::kEnabled);
  EXPECT_EQ(gantry.arm.counters().emergencies, 2u);
}

TEST(DriveProfile, TheFaultThatAWarningBecomesHasItsCode) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[2]->send(0x083, {0x10, 0x42, 0x08, 0, 0, 0, 0, 0});
  gantry.nodes[2]->statusword = 0x0218;
  gantry.cycle(ArmRequest::kEnabled, gantry.feedback.position);
  EXPECT_EQ(describe(gantry.arm.fault(), gantry.robot),
            "node 3 (z): drive fault 0x4210 (device too hot); see the drive's manual for the code");
}

// A pause of the whole program, say: no manual of a drive would tell.
TEST(DriveProfile, ADriveThatHeardNoMasterSendsPeopleToTheirComputer) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[2]->send(0x083, {0x30, 0x81, 0x11, 0, 0, 0, 0, 0});
  gantry.nodes[2]->statusword = 0x0218;
  gantry.cycle(ArmRequest::kEnabled, gantry.feedback.position);
  EXPECT_EQ(describe(gantry.arm.fault(), gantry.robot),
            "node 3 (z): drive fault 0x8130 (heartbeat of the master lost): it has not heard this "
            "program for its timeout; check what else this computer runs, late cycles, and the "
            "bus");
}

// A drive that has long been warm loses its encoder: the statusword tells of a fault, and only the
// next emergency of which.
TEST(DriveProfile, AFaultBesideAStandingWarningHasItsOwnCode) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[2]->send(0x083, {0x10, 0x42, 0x08, 0, 0, 0, 0, 0});
  gantry.cycle(ArmRequest::kEnabled, gantry.feedback.position);
  gantry.nodes[2]->statusword = 0x0218;
  gantry.cycle(ArmRequest::kEnabled, gantry.feedback.position);
  ASSERT_EQ(gantry.arm.fault().code, 0x4210U);
  gantry.nodes[2]->send(0x083, {0x05, 0x73, 0x20, 0, 0, 0, 0, 0});
  gantry.cycle(ArmRequest::kEnabled, gantry.feedback.position);
  EXPECT_EQ(gantry.arm.fault().node, 3);
  EXPECT_EQ(gantry.arm.fault().code, 0x7305U);
  // What follows from it changes nothing.
  gantry.nodes[2]->send(0x083, {0x11, 0x86, 0x20, 0, 0, 0, 0, 0});
  gantry.cycle(ArmRequest::kEnabled, gantry.feedback.position);
  EXPECT_EQ(gantry.arm.fault().code, 0x7305U);
}

TEST(DriveProfile, ACodeThatItsProfileDoesNotListStops) {
  Robot robot = gantry_robot();
  canopen_drive(robot.joints[2]).profile.warnings = {{0xFF00, 0xFFFF}};
  GantryOnBus gantry(robot);
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[2]->send(0x083, {0x10, 0x42, 0x08, 0, 0, 0, 0, 0});
  gantry.cycle(ArmRequest::kEnabled, gantry.feedback.position);
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kDriveFault);
}

}  // namespace
}  // namespace tenon::hw
