// Drive profiles as files: what is not by the book, and every way to write one wrongly, refused by
// file, line, key and range.

#include "shared/config/drive_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

#include "shared/canopen/drive_profile.h"
#include "shared/canopen/robot_drives.h"
#include "shared/config/files.h"
#include "shared/config/load.h"
#include "tests/shared/slide_robot.h"
#include "tests/support/places.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon {
namespace {

class DriveFile : public ::testing::Test {
 protected:
  DriveProfile loaded(const std::string& text) {
    write_file(folder.path() / "d.yaml", text);
    return load_drive(folder.path() / "d.yaml");
  }
  /// Without the folder.
  std::string refused(const std::string& text) {
    const std::string line = tests::refusal([&] { (void)loaded(text); });
    const std::string before = folder.path().string() + "/";
    return line.starts_with(before) ? line.substr(before.size()) : line;
  }

  tests::ScratchFolder folder;
};

TEST_F(DriveFile, WhatItLeavesOutIsByTheBook) {
  DriveProfile wanted;
  wanted.name = "mine";
  EXPECT_EQ(loaded("name: mine\n"), wanted);
}

TEST_F(DriveFile, SaysWhatADriveHasAndLacks) {
  const DriveProfile drive = loaded(
      "name: mine\nobjects: {6007h: absent, 6066h: {how: accept}, 6065h: {presence: optional}}\n"
      "extra: [{object: 2010h:3, type: i16, value: -2, presence: optional, how: clamp}]\n"
      "pdos: {mapping: fixed, identifiers: free}\nmodes: [7]\nboot_s: 2\n"
      "warnings: [4210h, FF00h-FFFFh]\n");
  EXPECT_EQ(drive.object(DriveObject::kConnectionOption).presence, Presence::kAbsent);
  EXPECT_EQ(drive.object(DriveObject::kFollowingTimeout).treatment, Treatment::kAccept);
  EXPECT_EQ(drive.object(DriveObject::kFollowingWindow).presence, Presence::kOptional);
  EXPECT_EQ(drive.object(DriveObject::kFollowingWindow).treatment, Treatment::kClamp);
  ASSERT_EQ(drive.extra.size(), 1u);
  EXPECT_EQ(
      drive.extra[0],
      (DriveProfile::Extra{0x2010, 3, 2, 0xFFFFFFFE, {Presence::kOptional, Treatment::kClamp}}));
  EXPECT_TRUE(drive.fixed_mapping);
  EXPECT_FALSE(drive.fixed_identifiers);
  EXPECT_EQ(drive.modes, (std::vector<std::uint8_t>{7}));
  EXPECT_TRUE(drive.warns(0x4210) && drive.warns(0xFF11) && !drive.warns(0x4211));
}

TEST_F(DriveFile, RefusesByFileLineKeyAndRange) {
  EXPECT_EQ(refused("name: a\nboot_s: 2.5\n"), "d.yaml:2: boot_s = 2.5, must be in (0, 2]");
  EXPECT_EQ(refused("name: a\nmodes: [6]\n"), "d.yaml:2: modes[0] = 6, must be one of: 7, 8");
  EXPECT_NE(refused("name: a\nboot: 1\n").find("d.yaml:2: boot: is an unknown key"),
            std::string::npos);
  EXPECT_NE(refused("name: a\nobjects: {6099h: absent}\n")
                .find("d.yaml:2: objects.6099h: is no object that a profile tells of"),
            std::string::npos);
  EXPECT_EQ(refused("name: a\nobjects: {6007h: gone}\n"),
            "d.yaml:2: objects.6007h = gone, must be one of: required, optional, absent");
  EXPECT_EQ(refused("name: a\nobjects: {6502h: {how: write}}\n"),
            "d.yaml:2: objects.6502h.how = write, must be check or accept: nobody writes what a "
            "drive supports");
  EXPECT_EQ(refused("name: a\nwarnings: [4210]\n"),
            "d.yaml:2: warnings[0] = 4210, must be an error code such as 4210h or a range such as "
            "FF00h-FFFFh");
  EXPECT_EQ(refused("name: a\nextra: [{object: 6040h, type: u16, value: 1}]\n"),
            "d.yaml:2: extra[0].object: is set by the master itself; see objects, pdos and modes");
  EXPECT_EQ(refused("name: a\nextra: [{object: 2010h, type: u8, value: 256}]\n"),
            "d.yaml:2: extra[0].value = 256, must be in [0, 255]");
  EXPECT_EQ(refused("name: a\nextra: [{object: 2010h:x, type: u8, value: 2}]\n"),
            "d.yaml:2: extra[0].object = 2010h:x, must be an object such as 2010h or 2010h:1");
  EXPECT_EQ(refused("name: a\nextra: [{object: 2010h, type: u8, value: 2},\n"
                    " {object: 2010h, type: u8, value: 2}]\n"),
            "d.yaml:3: extra[1].object = 2010h, must be listed once");
  EXPECT_EQ(refused("boot_s: 1\n"), "d.yaml:1: the required key name is missing");
}

TEST_F(DriveFile, ADriveThatIsNotThereIsRefusedAtTheJoint) {
  std::string robot = config::read_file(tests::in_tree("hw/robots/epos4/robot.yaml"));
  const std::string urdf = tests::in_tree("hw/robots/gantry3/gantry3.urdf");
  robot.replace(robot.find("../gantry3/gantry3.urdf"), 23, urdf);
  for (const std::string& name : {std::string("nobodys"), std::string(5000, 'x')}) {
    std::string other = robot;
    other.replace(other.find("maxon_epos4"), 11, name);
    write_file(folder.path() / "robot.yaml", other);
    const std::string line =
        tests::refusal([&] { (void)load_robot(folder.path() / "robot.yaml"); });
    EXPECT_NE(line.find("joints[0].drive = "), std::string::npos) << line;
    EXPECT_NE(line.find("does not exist"), std::string::npos) << line;
  }
}

TEST_F(DriveFile, ARobotsJointNamesItsDrive) {
  const Robot robot = load_robot(tests::in_tree("hw/robots/lwa4p/robot.yaml"));
  for (const Joint& joint : robot.joints)
    EXPECT_EQ(canopen_drive(joint).profile.name, "schunk_lwa4p");
  const Robot book = load_robot(tests::in_tree("hw/robots/csp6/robot.yaml"));
  for (const Joint& joint : book.joints) EXPECT_EQ(canopen_drive(joint).profile, DriveProfile{});
  const auto files = cell_files(tests::in_tree("hw/cells/lwa4p.yaml"));
  const auto of_drive = std::count_if(files.begin(), files.end(), [](const auto& file) {
    return file.filename() == "schunk_lwa4p.yaml";
  });
  EXPECT_EQ(of_drive, 1);
}

TEST(DriveOfARobot, HasTheModeOfItsJoint) {
  const tests::ScratchFolder folder;
  folder.put("slide.urdf", tests::kSlideUrdf);
  const Robot robot = load_robot(folder.put("robot.yaml", tests::kSlideRobot));
  EXPECT_EQ(canopen_drive(robot.joints[0]).mode, DriveMode::kCyclicSynchronousPosition);
  EXPECT_EQ(canopen_drive(robot.joints[1]).mode, DriveMode::kInterpolatedPosition);
}

TEST(DriveOfARobot, IsByTheBookUntilSomebodyChangesIt) {
  Joint joint;
  EXPECT_EQ(canopen_drive(std::as_const(joint)).profile, DriveProfile{});
  EXPECT_FALSE(joint.drive.has_value()) << "asking makes nothing";
  canopen_drive(joint).profile.boot_s = 2.0;
  const Joint copy = joint;
  canopen_drive(joint).profile.boot_s = 0.5;
  EXPECT_EQ(canopen_drive(copy).profile.boot_s, 2.0) << "a copy is of its own";
}

}  // namespace
}  // namespace tenon
