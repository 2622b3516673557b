// A virtual drive in the likeness of a device's file: what that says is what the bus sees, by the
// abort codes of CiA 301. The client at the other end shares nothing with either.

#include "sim/cell/canopen/twin.h"

#include <gtest/gtest.h>

#include <string>

#include "shared/eds/device_file.h"
#include "tests/sim/device_bench.h"
#include "tests/support/twins.h"

namespace tenon::sim {
namespace {

constexpr std::uint32_t kNoObject = 0x06020000;
constexpr std::uint32_t kNoSub = 0x06090011;
constexpr std::uint32_t kReadOnly = 0x06010002;
constexpr std::uint32_t kNotMappable = 0x06040041;
constexpr std::uint32_t kTooHigh = 0x06090031;
constexpr std::uint32_t kTooLow = 0x06090032;
constexpr std::uint32_t kLength = 0x06070012;

void become(DriveBench& bench, const DeviceFile& file) {
  bench.drive.become_twin(file);
  bench.drive.node().power_on(bench.now_ns);
  bench.pass(10);
}

TEST(Twin, LacksWhatItsFileLacksAndKeepsWhatCiaDemands) {
  DriveBench bench(7);
  become(bench, tests::twin_file("lwa4p"));
  constexpr std::uint16_t kLacking[] = {0x1006, 0x6007, 0x605A, 0x605B, 0x605C, 0x6066,
                                        0x6072, 0x6085, 0x2030, 0x1401, 0x1801, 0x1010};
  for (const std::uint16_t index : kLacking) {
    EXPECT_EQ(bench.read_abort({index, 0}), kNoObject) << std::hex << index;
    EXPECT_EQ(bench.write_u16({index}, 1), kNoObject) << std::hex << index;
  }
  EXPECT_EQ(bench.read_abort({0x60C2, 2}), kNoSub);
  EXPECT_EQ(bench.value({0x60C2, 1}), 8u);
  EXPECT_EQ(bench.value({0x6502}), 0x43u);
  EXPECT_EQ(bench.value({0x1000}), 0x00020192u);
  EXPECT_EQ(bench.read_abort({0x1001}), 0u);
}

TEST(Twin, StartsWithTheIdentifiersTypesAndMappingsOfItsFile) {
  DriveBench bench(7);
  become(bench, tests::twin_file("lwa4p"));
  EXPECT_EQ(bench.value({0x1400, 1}), 0x205u);
  EXPECT_EQ(bench.value({0x1400, 2}), 255u);
  EXPECT_EQ(bench.value({0x1600, 0}), 2u);
  EXPECT_EQ(bench.value({0x1600, 2}), 0x60C10120u);
  EXPECT_EQ(bench.value({0x1A00, 3}), 0x60640020u);
  bench.start();
  bench.pass(2);
  const auto frames = bench.pdos(0x185);
  ASSERT_FALSE(frames.empty()) << "a TPDO of type 255 tells what it is";
  EXPECT_EQ(frames.back().size(), 8u);
}

TEST(Twin, HasTheAccessAndTheLimitsOfItsFile) {
  DriveBench bench;
  become(bench, tests::twin_file("epos4"));
  EXPECT_EQ(bench.write_u32({0x1005}, 0x80), kReadOnly);
  EXPECT_EQ(bench.value({0x1005}), 0x80u);
  EXPECT_EQ(bench.write_u16({0x6066}, 10), kTooHigh);
  EXPECT_EQ(bench.write_u32({0x6085}, 0), kTooLow);
  EXPECT_EQ(bench.write_u8({0x60C2, 1}, 101), kTooHigh);
  EXPECT_EQ(bench.write_u8({0x60C2, 1}, 100), 0u);
  EXPECT_EQ(bench.value({0x605A}), 6u);
  EXPECT_EQ(bench.value({0x6065}), 2000u);
  EXPECT_EQ(bench.value({0x1800, 1}), 0x40000185u);
}

TEST(Twin, StoresWhatOnlyItsFileHas) {
  const DeviceFile file =
      parse_device_file("a.eds",
                        "[2030]\nDataType=6\nAccessType=rw\nDefaultValue=7\nHighLimit=9\n"
                        "[2031]\nDataType=7\nAccessType=ro\nDefaultValue=$NODEID+0x100\n");
  DriveBench bench;
  become(bench, file);
  EXPECT_EQ(bench.value({0x2030}), 7u);
  EXPECT_EQ(bench.write_u16({0x2030}, 9), 0u);
  EXPECT_EQ(bench.value({0x2030}), 9u);
  EXPECT_EQ(bench.write_u16({0x2030}, 10), kTooHigh);
  EXPECT_EQ(bench.write_u32({0x2030}, 1), kLength);
  EXPECT_EQ(bench.value({0x2031}), 0x105u);
}

TEST(Twin, DoesNothingAboutALostMasterWhereItsFileHasNo6007) {
  for (const auto& [name, mode, state] :
       {std::tuple{"lwa4p", std::int8_t{7}, 0x27}, {"epos4", std::int8_t{8}, 0x07}}) {
    DriveBench bench(mode);
    become(bench, tests::twin_file(name));
    bench.write_u8({0x6060}, mode);
    bench.write_u8({0x60C2, 1}, 2);
    bench.write_u32({0x1016, 1}, 0x007F0064);
    bench.start();
    bench.control(0x06);
    bench.control(0x07);
    bench.control(mode == 7 ? 0x1F : 0x0F);
    bench.pass(25);
    ASSERT_EQ(bench.long_state(), 0x27) << name;
    bench.tell({0x77F, {0x05}});
    bench.pass(102);
    EXPECT_EQ(bench.long_state(), state) << name;
  }
}

TEST(Twin, AMappingThatNoFrameHoldsIsCut) {
  const DeviceFile file = parse_device_file(
      "a.eds",
      "[1A00]\nObjectType=9\nSubNumber=4\n[1A00sub0]\nDataType=5\nAccessType=rw\nDefaultValue=255\n"
      "[1A00sub1]\nDataType=7\nAccessType=rw\nDefaultValue=0x60410010\n"
      "[1A00sub2]\nDataType=7\nAccessType=rw\nDefaultValue=0x99990020\n"
      "[1800]\nObjectType=9\nSubNumber=2\n[1800sub0]\nDataType=5\nAccessType=ro\nDefaultValue=2\n"
      "[1800sub1]\nDataType=7\nAccessType=rw\nDefaultValue=$NODEID+0x180\n");
  DriveBench bench;
  become(bench, file);
  EXPECT_EQ(bench.value({0x1A00, 0}), 1u);
  bench.start();
  bench.sync();
  bench.pass(2);
  for (const auto& data : bench.pdos(0x185)) EXPECT_EQ(data.size(), 2u);
}

// A device by the book refuses at its mapping what would not work in motion.
TEST(Twin, MapsNothingAgainstItsAccess) {
  DeviceFile file = tests::twin_file("epos4");
  file.objects[0x607A00].access = DeviceObject::Access::kReadOnly;
  file.objects[0x606400].access = DeviceObject::Access::kReadWriteOutput;
  file.dummies = 0b1100'1110;
  DriveBench bench(7);
  become(bench, file);
  bench.write_u32({0x1400, 1}, 0x80000207);
  bench.write_u32({0x1800, 1}, 0x80000187);
  bench.write_u8({0x1600, 0}, 0);
  bench.write_u8({0x1A00, 0}, 0);
  EXPECT_EQ(bench.write_u32({0x1600, 1}, 0x607A0020), kNotMappable);
  EXPECT_EQ(bench.write_u32({0x1A00, 1}, 0x60640020), kNotMappable);
  EXPECT_EQ(bench.write_u32({0x1600, 1}, 0x00040020), kNotMappable);
  EXPECT_EQ(bench.write_u32({0x1600, 1}, 0x00070020), 0u);
  EXPECT_EQ(bench.write_u32({0x1600, 1}, 0x60400010), 0u);
}

TEST(Twin, AnswersWithRealNumbersOfItsFile) {
  DeviceFile file = tests::twin_file("epos4");
  DeviceObject real;
  real.type = 0x0008;
  real.text = "0.5";
  file.objects[0x2A0000] = real;
  DriveBench bench(7);
  become(bench, file);
  EXPECT_EQ(bench.value({0x2A00}), 0x3F000000u);
}

}  // namespace
}  // namespace tenon::sim
