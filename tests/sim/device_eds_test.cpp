// The EDS of every kind of device against the device itself: each entry that the file lists is read
// and written over SDO by the independent client, and nothing answers that it does not list.

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <set>

#include "shared/canopen/robot_drives.h"
#include "sim/cell/canopen/eds.h"
#include "sim/cell/devices/robot_devices.h"
#include "tests/sim/device_bench.h"
#include "tests/sim/eds_file.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/sim_process.h"

namespace tenon::sim {
namespace {

struct Device {
  const char* name;
  std::function<std::unique_ptr<DeviceBench>()> make;
};

class DeviceEdsTest : public ::testing::TestWithParam<Device> {
 protected:
  std::unique_ptr<DeviceBench> bench = GetParam().make();
  const EdsFileReader file{
      eds_text(bench->node().dictionary(),
               {.file_name = "test.eds", .product_name = "test", .node = DeviceBench::kNode})};

  static std::string where(const EdsEntry& entry) {
    std::ostringstream out;
    out << std::hex << entry.index << ":" << int{entry.sub} << " " << entry.name;
    return out.str();
  }
  static ObjectAddress address(const EdsEntry& entry) { return {entry.index, entry.sub}; }
  static std::int64_t default_number(const EdsEntry& entry) {
    return EdsFileReader::number_of(entry.default_text, DeviceBench::kNode);
  }
  /// What the device itself changes, and so may differ from its default.
  static bool is_process_value(const EdsEntry& entry) {
    return entry.access == "ro" && entry.mappable;
  }
};

INSTANTIATE_TEST_SUITE_P(
    Devices, DeviceEdsTest,
    ::testing::Values(Device{"mode 8", [] { return std::make_unique<DriveBench>(8); }},
                      Device{"mode 7", [] { return std::make_unique<DriveBench>(7); }},
                      Device{"sensor", [] { return std::make_unique<SensorBench>(); }}));

TEST_P(DeviceEdsTest, ListsExactlyTheIndicesThatAnswer) {
  std::set<std::uint16_t> listed;
  for (const char* list : {"MandatoryObjects", "OptionalObjects", "ManufacturerObjects"}) {
    for (const std::uint16_t index : file.listed(list)) {
      EXPECT_TRUE(listed.insert(index).second) << std::hex << index << " is listed twice";
      const bool manufacturers = index >= 0x2000 && index < 0x6000;
      EXPECT_EQ(manufacturers, std::string(list) == "ManufacturerObjects") << std::hex << index;
    }
  }
  for (std::uint32_t index = 0x1000; index < 0x7000; ++index) {
    const auto at = static_cast<std::uint16_t>(index);
    const bool answers = bench->read_abort({at}) != 0x06020000;
    EXPECT_EQ(answers, listed.count(at) == 1) << std::hex << index;
  }
  EXPECT_EQ(file.listed("MandatoryObjects"), (std::vector<std::uint16_t>{0x1000, 0x1001, 0x1018}));
}

TEST_P(DeviceEdsTest, ListsExactlyTheSubIndicesThatAnswer) {
  std::set<std::pair<std::uint16_t, std::uint8_t>> listed;
  for (const EdsEntry& entry : file.entries()) listed.insert({entry.index, entry.sub});
  for (const auto& [index, first] : std::set(listed)) {
    for (std::uint8_t sub = 0; sub < 20; ++sub) {
      const bool answers = bench->read_abort({index, sub}) != 0x06090011;
      EXPECT_EQ(answers, listed.count({index, sub}) == 1) << std::hex << index << ":" << int{sub};
    }
  }
}

TEST_P(DeviceEdsTest, TellsLengthAndDefaultOfWhatCanBeRead) {
  int compared = 0;
  for (const EdsEntry& entry : file.entries()) {
    SCOPED_TRACE(where(entry));
    EXPECT_FALSE(entry.name.empty());
    const CanopenClient::Answer answer = bench->read(address(entry));
    if (entry.access == "wo") {
      EXPECT_EQ(answer.abort, 0x06010001U);
      continue;
    }
    if (answer.abort == 0x08000024) continue;  // an error history without errors
    ASSERT_EQ(answer.abort, 0U);
    if (entry.bytes == 0) {
      EXPECT_EQ(std::string(answer.bytes.begin(), answer.bytes.end()), entry.default_text);
      continue;
    }
    EXPECT_EQ(answer.bytes.size(), entry.bytes);
    if (is_process_value(entry)) continue;
    EXPECT_EQ(answer.bytes, little_endian(default_number(entry), entry.bytes));
    ++compared;
  }
  EXPECT_GT(compared, 30);
}

TEST_P(DeviceEdsTest, TellsTheRightsAndTheLimitsOfWhatCanBeWritten) {
  for (const EdsEntry& entry : file.entries()) {
    if (entry.bytes == 0) continue;
    SCOPED_TRACE(where(entry));
    const ObjectAddress at = address(entry);
    const auto write = [&](std::int64_t value) {
      return bench->write(at, little_endian(value, entry.bytes));
    };
    if (entry.access == "ro") {
      EXPECT_EQ(write(default_number(entry)), 0x06010002U);
      continue;
    }
    ASSERT_TRUE(entry.access == "rw" || entry.access == "rww" || entry.access == "wo");
    EXPECT_EQ(bench->write(at, Bytes(entry.bytes + 1), Transfer::kSegmented), 0x06070012U);
    EXPECT_EQ(bench->write(at, Bytes(entry.bytes - 1), Transfer::kSegmented), 0x06070013U);
    const std::uint32_t below = entry.has_low ? write(entry.low - 1) : 0x06090032;
    EXPECT_EQ(below, 0x06090032U);
    const std::uint32_t above = entry.has_high ? write(entry.high + 1) : 0x06090031;
    EXPECT_EQ(above, 0x06090031U);
    // Within them it may still be refused: by the PDO's state, as no signature, as no option.
    static const std::set<std::uint32_t> kOtherReasons = {0,          0x08000022, 0x08000020,
                                                          0x06090030, 0x06040041, 0x06020000};
    EXPECT_EQ(kOtherReasons.count(write(entry.has_low ? entry.low : 1)), 1U);
    EXPECT_EQ(kOtherReasons.count(write(entry.has_high ? entry.high : 1)), 1U);
  }
}

TEST_P(DeviceEdsTest, TellsWhatAPdoMayCarry) {
  const bool receives = file.number("DeviceInfo", "NrOfRXPDO") > 0;
  ASSERT_EQ(bench->write_u32({0x1800, 1}, 0x80000185), 0U);
  ASSERT_EQ(bench->write_u8({0x1A00, 0}, 0), 0U);
  if (receives) {
    ASSERT_EQ(bench->write_u32({0x1400, 1}, 0x80000205), 0U);
    ASSERT_EQ(bench->write_u8({0x1600, 0}, 0), 0U);
  }
  for (const EdsEntry& entry : file.entries()) {
    SCOPED_TRACE(where(entry));
    const auto mapping = static_cast<std::uint32_t>(entry.index) << 16 |
                         static_cast<std::uint32_t>(entry.sub) << 8 |
                         static_cast<std::uint32_t>(8 * entry.bytes);
    const bool received = entry.access == "rww";
    EXPECT_EQ(bench->write_u32({0x1A00, 1}, mapping),
              entry.mappable && !received ? 0U : 0x06040041U);
    if (!receives) continue;
    EXPECT_EQ(bench->write_u32({0x1600, 1}, mapping),
              entry.mappable && received ? 0U : 0x06040041U);
  }
}

TEST_P(DeviceEdsTest, TellsWhoTheDeviceIs) {
  EXPECT_EQ(file.value("FileInfo", "EDSVersion"), "4.0");
  EXPECT_EQ(file.value("FileInfo", "FileName"), "test.eds");
  EXPECT_EQ(static_cast<std::uint64_t>(file.number("DeviceInfo", "VendorNumber")),
            bench->value({0x1018, 1}));
  EXPECT_EQ(static_cast<std::uint64_t>(file.number("DeviceInfo", "ProductNumber")),
            bench->value({0x1018, 2}));
  EXPECT_EQ(static_cast<std::uint64_t>(file.number("DeviceInfo", "RevisionNumber")),
            bench->value({0x1018, 3}));
  const bool drive = bench->value({0x1018, 2}) == 0x402;
  EXPECT_EQ(file.number("DeviceInfo", "NrOfRXPDO"), drive ? 4 : 0);
  EXPECT_EQ(file.number("DeviceInfo", "NrOfTXPDO"), drive ? 4 : 2);
}

TEST(EdsFilesTest, EveryNodeOfARobotHasOneWithItsOwnDefaults) {
  Robot robot;
  for (std::uint8_t node = 3; node <= 4; ++node) {
    Joint joint;
    joint.name = "j" + std::to_string(node);
    joint.node = node;
    canopen_drive(joint).mode = DriveMode::kInterpolatedPosition;
    joint.counts_per_unit = -1000.0;
    joint.acceleration_max = 2.5;
    joint.effort_max = 30.0;
    joint.rated_effort = 20.0;
    robot.joints.push_back(joint);
  }
  robot.sensor = SensorBench::sheet(0.0);
  const std::vector<EdsFile> files = eds_files(robot);
  ASSERT_EQ(files.size(), 3U);
  EXPECT_EQ(files[0].name, "3-drive-j3.eds");
  EXPECT_EQ(files[1].name, "4-drive-j4.eds");
  EXPECT_EQ(files[2].name, "5-sensor.eds");
  const EdsFileReader drive(files[1].text);
  EXPECT_EQ(drive.value("FileInfo", "FileName"), "4-drive-j4.eds");
  EXPECT_EQ(drive.value("1008", "DefaultValue"), "tenon virtual drive j4");
  EXPECT_EQ(drive.value("1800sub1", "DefaultValue"), "$NODEID+0x180");
  EXPECT_EQ(drive.number("6085", "DefaultValue"), 2500);
  EXPECT_EQ(drive.number("6072", "DefaultValue"), 1500);
  EXPECT_EQ(drive.number("6076", "DefaultValue"), 20000);
  EXPECT_EQ(drive.number("6502", "DefaultValue"), 0x40);
}

TEST(EdsFilesTest, TheSimulatorWritesThemForItsCell) {
  const tests::ScratchFolder folder;
  std::filesystem::create_directory(folder.path() / "eds");
  const tests::SimProcess sim(folder.path(), "1", {"--eds", (folder.path() / "eds").string()});
  const EdsFileReader sensor(folder.get("eds/4-sensor.eds"));
  EXPECT_EQ(sensor.value("6401sub1", "ParameterName"), "Force x");
  const EdsFileReader drive(folder.get("eds/1-drive-x.eds"));
  EXPECT_EQ(drive.number("6502", "DefaultValue"), 0x80);
}

}  // namespace
}  // namespace tenon::sim
