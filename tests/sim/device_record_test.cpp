// What a device keeps about itself: identity, error register and history, emergencies' identifier,
// stored settings.

#include <gtest/gtest.h>

#include "tests/sim/device_bench.h"

namespace tenon::sim {
namespace {

constexpr std::uint32_t kSave = 0x65766173;  // "save"
constexpr std::uint32_t kLoad = 0x64616F6C;  // "load"

std::string text(const CanopenClient::Answer& answer) {
  return {answer.bytes.begin(), answer.bytes.end()};
}

TEST(DeviceRecordTest, TellsItsIdentity) {
  DriveBench drive;
  EXPECT_EQ(drive.value({0x1018, 0}), 4U);
  EXPECT_EQ(drive.value({0x1018, 1}), 0U) << "no vendor";
  EXPECT_EQ(drive.value({0x1018, 2}), 0x402U);
  EXPECT_EQ(drive.value({0x1018, 3}), 0x00010000U);
  EXPECT_EQ(drive.value({0x1018, 4}), 5U);
  EXPECT_EQ(text(drive.read({0x1009})), "virtual");
  EXPECT_EQ(text(drive.read({0x100A})), "1.0");
  SensorBench sensor;
  EXPECT_EQ(sensor.value({0x1018, 2}), 0x404U);
}

TEST(DeviceRecordTest, RemembersErrorsTheLatestFirstAndForgetsThemByZero) {
  DriveBench bench;
  bench.start();
  EXPECT_EQ(bench.value({0x1003, 0}), 0U);
  EXPECT_EQ(bench.read_abort({0x1003, 1}), 0x08000024U);
  bench.tell({0x205, {}});             // 8210h
  bench.tell(CanopenClient::sync(1));  // 8240h
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x8210, 0x11}, {0x8240, 0x11}}));
  EXPECT_EQ(bench.value({0x1003, 0}), 2U);
  EXPECT_EQ(bench.value({0x1003, 1}), 0x8240U);
  EXPECT_EQ(bench.value({0x1003, 2}), 0x8210U);
  EXPECT_EQ(bench.read_abort({0x1003, 3}), 0x08000024U);
  EXPECT_EQ(bench.read_abort({0x1003, 9}), 0x06090011U);
  bench.tell({0x205, {0x06, 0x00}});
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x0000, 0x11}})) << "the other one is still there";
  bench.sync();
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x0000, 0x00}}));
  EXPECT_EQ(bench.value({0x1003, 0}), 2U) << "the history stays";
  EXPECT_EQ(bench.write_u8({0x1003, 0}, 1), 0x06090030U);
  EXPECT_EQ(bench.write_u8({0x1003, 0}, 0), 0U);
  EXPECT_EQ(bench.value({0x1003, 0}), 0U);
  EXPECT_EQ(bench.read_abort({0x1003, 1}), 0x08000024U);
}

TEST(DeviceRecordTest, KeepsTheLastEightErrors) {
  SensorBench bench;
  bench.start();
  for (int i = 1; i <= 10; ++i) {
    bench.sensor.inject({.kind = FaultKind::kEmergency, .value = 0x5000 + i * 1.0});
  }
  EXPECT_EQ(bench.value({0x1003, 0}), 8U);
  EXPECT_EQ(bench.value({0x1003, 1}), 0x500AU);
  EXPECT_EQ(bench.value({0x1003, 8}), 0x5003U);
}

/// An error code and the bits of 1001h that its class sets.
class ErrorClassTest : public ::testing::TestWithParam<std::pair<std::uint16_t, std::uint8_t>> {};

TEST_P(ErrorClassTest, SetsItsBitOfTheErrorRegister) {
  SensorBench bench;
  bench.sensor.inject({.kind = FaultKind::kEmergency, .value = GetParam().first * 1.0});
  bench.listen();
  EXPECT_EQ(bench.emergencies(), (Emergencies{{GetParam().first, GetParam().second}}));
  EXPECT_EQ(bench.value({0x1001}), GetParam().second);
}

INSTANTIATE_TEST_SUITE_P(Classes, ErrorClassTest,
                         ::testing::Values(std::pair(0x1000, 0x01), std::pair(0x2310, 0x03),
                                           std::pair(0x3210, 0x05), std::pair(0x4310, 0x09),
                                           std::pair(0x5000, 0x01), std::pair(0x6100, 0x01),
                                           std::pair(0x7300, 0x21), std::pair(0x8110, 0x11),
                                           std::pair(0x8210, 0x11), std::pair(0x8611, 0x21),
                                           std::pair(0xFF00, 0x81)));

TEST(DeviceRecordTest, EmergenciesMayGoElsewhereOrNowhere) {
  DriveBench bench;
  EXPECT_EQ(bench.value({0x1014}), 0x85U);
  EXPECT_EQ(bench.write_u32({0x1014}, 0x601), 0x06090030U);
  EXPECT_EQ(bench.write_u32({0x1014}, 0x95), 0U);
  bench.start();
  bench.tell({0x205, {}});
  EXPECT_EQ(bench.pdos(0x95).size(), 1U);
  EXPECT_EQ(bench.write_u32({0x1014}, 0x80000085), 0U);
  bench.tell({0x205, {0x06, 0x00}});
  EXPECT_TRUE(bench.emergencies().empty());
}

TEST(DeviceRecordTest, WhatWasWrittenIsLostByAResetUnlessItWasStored) {
  DriveBench bench;
  EXPECT_EQ(bench.value({0x1010, 1}), 1U) << "stores on command";
  EXPECT_EQ(bench.write_u32({0x6065}, 777), 0U);
  bench.tell(bench.client.nmt(0x81));
  EXPECT_EQ(bench.value({0x6065}), 0U);
  EXPECT_EQ(bench.write_u32({0x6065}, 777), 0U);
  EXPECT_EQ(bench.write_u16({0x1017}, 100), 0U);
  EXPECT_EQ(bench.write({0x2000}, {'z', '1'}), 0U);
  EXPECT_EQ(bench.write_u32({0x607A}, 4242), 0U) << "process data, which is no setting";
  EXPECT_EQ(bench.write_u32({0x1010, 1}, kSave), 0U);
  EXPECT_EQ(bench.value({0x1010, 1}), 1U);
  EXPECT_EQ(bench.write_u32({0x6065}, 888), 0U);
  bench.tell(bench.client.nmt(0x81));
  EXPECT_EQ(bench.value({0x6065}), 777U);
  EXPECT_EQ(bench.value({0x1017}), 100U);
  EXPECT_EQ(text(bench.read({0x2000})), "z1");
  EXPECT_EQ(bench.value({0x607A}), 0U);
}

TEST(DeviceRecordTest, DefaultsComeBackWithTheResetAfterLoad) {
  DriveBench bench;
  EXPECT_EQ(bench.write_u32({0x6065}, 777), 0U);
  EXPECT_EQ(bench.write_u32({0x1010, 1}, kSave), 0U);
  EXPECT_EQ(bench.write_u32({0x1011, 1}, kSave), 0x08000020U);
  EXPECT_EQ(bench.write_u32({0x1011, 1}, kLoad), 0U);
  EXPECT_EQ(bench.value({0x6065}), 777U) << "not before the reset";
  bench.tell(bench.client.nmt(0x81));
  EXPECT_EQ(bench.value({0x6065}), 0U);
}

TEST(DeviceRecordTest, ACommunicationResetKeepsTheDevicesOwnErrorAndSettings) {
  DriveBench bench;
  bench.start();
  EXPECT_EQ(bench.write_u32({0x6065}, 777), 0U);
  EXPECT_EQ(bench.write_u32({0x1016, 1}, 0x007F0064), 0U);
  bench.drive.inject({.kind = FaultKind::kEmergency, .value = 0x5000});
  bench.tell({0x205, {}});
  EXPECT_EQ(bench.value({0x1001}), 0x11U);
  bench.tell(bench.client.nmt(0x82));
  EXPECT_EQ(bench.value({0x1001}), 0x01U) << "the communication's error is gone, the fault is not";
  EXPECT_EQ(bench.short_state(), 0x08);
  EXPECT_EQ(bench.value({0x6065}), 777U);
  EXPECT_EQ(bench.value({0x1016, 1}), 0U);
  bench.tell(bench.client.nmt(0x81));
  EXPECT_EQ(bench.value({0x1001}), 0x00U);
}

}  // namespace
}  // namespace tenon::sim
