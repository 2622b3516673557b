// What tenon-can check says of a robot's drives by their description files, and that it says what
// bring-up then does.

#include "hw/check/device_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hw/check/mapping_check.h"
#include "hw/check/object_names.h"
#include "shared/canopen/robot_drives.h"
#include "shared/config/files.h"
#include "shared/config/load.h"
#include "tests/support/places.h"

namespace tenon::hw {
namespace {

DeviceFile twin(const std::string& name) {
  const std::string file = "tests/twins/" + name + ".eds";
  return parse_device_file(file, config::read_file(tests::in_tree(file)));
}

Robot robot(const std::string& name) {
  return load_robot(tests::in_tree("hw/robots/" + name + "/robot.yaml"));
}

std::map<std::uint8_t, DeviceFile> for_all(const Robot& robot, const DeviceFile& file) {
  std::map<std::uint8_t, DeviceFile> files;
  for (const Joint& joint : robot.joints) files.emplace(joint.node, file);
  return files;
}

const CheckLine& line_of(const std::vector<CheckLine>& lines, std::uint16_t index,
                         std::uint8_t sub = 0) {
  const auto found = std::find_if(lines.begin(), lines.end(), [&](const CheckLine& line) {
    return line.setting.index == index && line.setting.sub == sub;
  });
  EXPECT_NE(found, lines.end()) << std::hex << index;
  return *found;
}

TEST(DeviceCheck, TheShippedRobotsComeUpOnTheirOwnDrives) {
  for (const auto& [name, file] : {std::pair{"lwa4p", "lwa4p"}, {"epos4", "epos4"}}) {
    const Robot it = robot(name);
    const CheckReport report = check_report(it, for_all(it, twin(file)));
    EXPECT_TRUE(report.good) << report.text;
    EXPECT_TRUE(report.text.ends_with("verdict: would come up\n")) << report.text;
  }
}

TEST(DeviceCheck, ADriveByTheBookIsRefusedByTheObjectsThatTheLwaLacks) {
  Robot it = robot("lwa4p");
  for (Joint& joint : it.joints) canopen_drive(joint).profile = DriveProfile{};
  const DeviceFile file = twin("lwa4p");
  std::vector<std::uint32_t> refused;
  for (const CheckLine& line : check_joint(it, 0, &file)) {
    if (line.verdict == CheckLine::Verdict::kRefused) refused.push_back(line.setting.object());
  }
  EXPECT_EQ(refused, (std::vector<std::uint32_t>{0x60C202, 0x600700, 0x605A00, 0x605B00, 0x605C00,
                                                 0x608500, 0x606600}));
  const CheckReport report = check_report(it, for_all(it, file));
  EXPECT_FALSE(report.good);
  EXPECT_NE(report.text.find("verdict: refused, 42 objects"), std::string::npos) << report.text;
}

TEST(DeviceCheck, SaysRangeAccessAndSize) {
  Robot it = robot("epos4");
  for (Joint& joint : it.joints) canopen_drive(joint).profile = DriveProfile{};
  DeviceFile file = twin("epos4");
  file.objects[0x608500].type = 0x0006;
  file.objects[0x101700].access = DeviceObject::Access::kReadOnly;
  const auto lines = check_joint(it, 0, &file);
  EXPECT_EQ(line_of(lines, 0x6066).device, "rw, 16 bits: at most 0 (abort 0x06090031)");
  EXPECT_EQ(line_of(lines, 0x6085).device,
            "rw, 16 bits: has 16 bits where 32 are written (abort 0x06070010)");
  EXPECT_EQ(line_of(lines, 0x1017).device, "ro, 16 bits: cannot be written (abort 0x06010002)");
}

TEST(DeviceCheck, AFixedMappingThatIsTheOneWantedIsLeftAlone) {
  const Robot it = robot("lwa4p");
  DeviceFile file = twin("lwa4p");
  for (const std::uint32_t index : {0x1600u, 0x1A00u}) {
    for (std::uint32_t sub = 0; sub <= 8; ++sub) {
      file.objects[index << 8 | sub].access = DeviceObject::Access::kConstant;
    }
  }
  EXPECT_TRUE(check_report(it, for_all(it, file)).good);
  file.objects[0x160002].value = 0x607A0020;
  EXPECT_FALSE(check_report(it, for_all(it, file)).good);
}

// What a PDO carries must be there, as wide as it is mapped, and go that way: 6077h is told, 607Ah
// is told the drive.
TEST(DeviceCheck, WhatAMappingNamesIsLookedAt) {
  const Robot it = robot("epos4");
  DeviceFile good = twin("epos4");
  // Mapped otherwise from its factory.
  good.objects[0x160000].value = good.objects[0x1A0000].value = 0;
  const auto entry_of = [&](const DeviceFile& file, std::uint32_t mapped) {
    for (const CheckLine& line : check_joint(it, 0, &file)) {
      const bool written = line.setting.action == canopen::ObjectSetting::Action::kWriteIfOther;
      if (written && line.setting.value >> 8 == mapped) return line;
    }
    ADD_FAILURE() << std::hex << mapped << " is not mapped";
    return CheckLine{};
  };
  const auto without = [&](auto change) {
    DeviceFile file = good;
    change(file);
    return file;
  };
  const auto refused = [&](std::uint32_t mapped, auto change, const std::string& why) {
    const CheckLine line = entry_of(without(change), mapped);
    EXPECT_EQ(line.verdict, CheckLine::Verdict::kRefused) << line.device;
    EXPECT_NE(line.device.find(why), std::string::npos) << line.device;
  };
  using Access = DeviceObject::Access;
  EXPECT_EQ(entry_of(good, 0x607700).verdict, CheckLine::Verdict::kGood);
  refused(
      0x607700, [](DeviceFile& file) { file.objects[0x607700].mappable = false; },
      "6077h:0 goes into no TPDO (abort 0x06040041)");
  refused(
      0x607700, [](DeviceFile& file) { file.objects.erase(0x607700); },
      "6077h:0 is no object that it has (abort 0x06020000)");
  refused(
      0x607700, [](DeviceFile& file) { file.objects[0x607700].type = 0x0004; },
      "6077h:0 has 32 bits where 16 are mapped (abort 0x06070010)");
  refused(
      0x607700, [](DeviceFile& file) { file.objects[0x607700].access = Access::kWriteOnly; },
      "goes into no TPDO");
  for (const Access access : {Access::kReadOnly, Access::kConstant, Access::kReadWriteInput}) {
    refused(
        0x607A00, [&](DeviceFile& file) { file.objects[0x607A00].access = access; },
        "607Ah:0 goes into no RPDO (abort 0x06040041)");
  }
}

TEST(DeviceCheck, GapsAreTakenWhereTheFileSaysSo) {
  const Robot it = robot("csp6");
  DeviceFile file;
  const auto gap = [&] { return answer_to_mapping(file, 0x1601, 0x00040020).kind; };
  EXPECT_EQ(gap(), MappingAnswer::Kind::kUnknown);
  file.dummies = 0b0001'0000;
  EXPECT_EQ(gap(), MappingAnswer::Kind::kTaken);
  file.dummies = 0b1110'1110;
  EXPECT_EQ(gap(), MappingAnswer::Kind::kRefused);
  EXPECT_EQ(answer_to_mapping(file, 0x1A00, 0x00050008).kind, MappingAnswer::Kind::kRefused)
      << "who sends has no gaps";
}

// Neither would it come up nor would it not.
TEST(DeviceCheck, WhatTheFileDoesNotSayIsInTheVerdict) {
  const Robot it = robot("epos4");
  DeviceFile file = twin("epos4");
  file.objects[0x650200].value.reset();
  const CheckReport report = check_report(it, for_all(it, file));
  EXPECT_TRUE(report.good);
  EXPECT_NE(report.text.find("verdict: nothing refused; of 3 objects the file does not say what "
                             "bring-up needs"),
            std::string::npos)
      << report.text;
}

// The RPDO by which all drives are stopped at once: a device that refuses it comes up without, is
// asked for no more of it, and is named.
TEST(DeviceCheck, ADriveWithoutARpdoForTheStopIsNamedAndSparedTheRest) {
  const Robot it = robot("epos4");
  const DeviceFile file = twin("epos4");
  std::vector<CheckLine> tried = check_joint(it, 0, &file);
  std::erase_if(tried, [](const CheckLine& line) {
    return line.setting.action != canopen::ObjectSetting::Action::kTry;
  });
  ASSERT_GT(tried.size(), 2U);
  EXPECT_EQ(tried.front().device, "has no such object, brought up without");
  for (std::size_t i = 1; i < tried.size(); ++i) {
    EXPECT_EQ(tried[i].device, "not asked any more") << i;
    EXPECT_EQ(tried[i].verdict, CheckLine::Verdict::kOther) << i;
  }
  const CheckReport report = check_report(it, for_all(it, file));
  EXPECT_TRUE(report.good);
  EXPECT_NE(report.text.find("node 1 (x): has no free RPDO"), std::string::npos) << report.text;
}

// Known from the profile alone.
TEST(DeviceCheck, ADriveWhosePdosAreFixedIsNamedWithoutAFile) {
  Robot it = robot("epos4");
  EXPECT_EQ(check_report(it, {}).text.find("has no free RPDO"), std::string::npos);
  canopen_drive(it.joints[1]).profile.fixed_mapping = true;
  const std::string text = check_report(it, {}).text;
  EXPECT_NE(text.find("node 2 (y): has no free RPDO"), std::string::npos) << text;
  EXPECT_EQ(text.find("has no free RPDO"), text.rfind("has no free RPDO")) << text;
}

TEST(DeviceCheck, WithoutAFileItSaysWhatItWouldDo) {
  const CheckReport report = check_report(robot("csp6"), {});
  EXPECT_TRUE(report.good);
  EXPECT_NE(report.text.find("6 joints without a description file"), std::string::npos);
  EXPECT_NE(report.text.find("  6007h:0  lost-connection option   write 0x3 "), std::string::npos)
      << report.text;
  EXPECT_NE(report.text.find("bus: "), std::string::npos);
}

std::size_t times_found(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
    ++found;
  }
  return found;
}

// Six drives of a kind say the same; who reads it looks for what is not.
TEST(DeviceCheck, JointsThatAreAlikeAreToldOnce) {
  const Robot it = robot("lwa4p");
  const std::string text = check_report(it, for_all(it, twin("lwa4p"))).text;
  EXPECT_EQ(times_found(text, "\n  6065h:0 "), 1u) << text;
  EXPECT_EQ(times_found(text, ": as node 3, but for\n"), 5u);
  EXPECT_EQ(times_found(text, "\n  1800h:1 "), 12u) << "every node has identifiers of its own";
  EXPECT_EQ(times_found(text, " \n"), 0u) << "no space ends a line";
}

TEST(DeviceCheck, WhatIsRefusedIsToldForEveryJoint) {
  const Robot it = robot("lwa4p");
  DeviceFile file = twin("lwa4p");
  file.objects[0x101700].access = DeviceObject::Access::kReadOnly;
  const std::string text = check_report(it, for_all(it, file)).text;
  EXPECT_EQ(times_found(text, "REFUSED"), it.joints.size()) << text;
}

TEST(DeviceCheck, SaysWhichBitsAreExpectedAndWhyNothingIsToBeDone) {
  const Robot it = robot("epos4");
  const std::string text = check_report(it, for_all(it, twin("epos4"))).text;
  EXPECT_NE(text.find("expect 0x192 in bits 0xFFFF"), std::string::npos) << text;
  EXPECT_NE(text.find("good      without the object nothing is to be done"), std::string::npos)
      << text;
  EXPECT_NE(text.find("left out  has no such object, brought up without"), std::string::npos);
}

TEST(DeviceCheck, EveryObjectOfBringUpHasAName) {
  for (const char* name : {"gantry3", "csp6", "lwa4p", "epos4"}) {
    for (const CheckLine& line : check_joint(robot(name), 0, nullptr)) {
      EXPECT_FALSE(object_name(line.setting.index).empty()) << std::hex << line.setting.index;
    }
  }
  EXPECT_EQ(object_name(0x1401), "RPDO 2 identifier, type, deadline");
  EXPECT_EQ(object_name(0x1A03), "TPDO 4 mapping");
  EXPECT_EQ(object_name(0x2000), "");
}

TEST(DeviceCheck, AnOverloadedBusIsRefusedWithItsNumbers) {
  Robot it = robot("csp6");
  it.targets_per_frame = 1;
  const CheckReport report = check_report(it, {});
  EXPECT_FALSE(report.good);
  EXPECT_NE(report.text.find("load a bus of 1000000 bit/s"), std::string::npos) << report.text;
}

}  // namespace
}  // namespace tenon::hw
