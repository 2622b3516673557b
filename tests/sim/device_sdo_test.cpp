// Every way of an SDO transfer, and every abort code that a device gives, with the devices' own
// objects and the independent client.

#include <gtest/gtest.h>

#include "tests/sim/device_bench.h"

namespace tenon::sim {
namespace {

const Bytes kLongText = {'a', ' ', 'l', 'a', 'b', 'e', 'l', ' ', 'o', 'f',
                         ' ', '2', '0', ' ', 'b', 'y', 't', 'e', 's', '.'};

TEST(DeviceSdoTest, UploadsAreExpeditedUpToFourBytesAndSegmentedBeyond) {
  DriveBench bench;
  EXPECT_EQ(bench.read({0x1001}).bytes.size(), 1U);
  EXPECT_EQ(bench.read({0x6041}).bytes.size(), 2U);
  EXPECT_EQ(bench.read({0x1000}).bytes, (Bytes{0x92, 0x01, 0x02, 0x00}));
  EXPECT_FALSE(bench.read({0x1000}).segmented);
  const CanopenClient::Answer name = bench.read({0x1008});
  EXPECT_EQ(std::string(name.bytes.begin(), name.bytes.end()), "tenon virtual drive");
  EXPECT_TRUE(name.segmented);
  EXPECT_TRUE(bench.client.complaints.empty());
}

TEST(DeviceSdoTest, EveryKindOfDownloadStoresTheSame) {
  DriveBench bench;
  int period = 100;
  for (const Transfer transfer : {Transfer::kExpedited, Transfer::kExpeditedUnsized,
                                  Transfer::kSegmented, Transfer::kSegmentedUnsized}) {
    EXPECT_EQ(bench.write({0x1017}, little_endian(++period, 2), transfer), 0U);
    EXPECT_EQ(bench.value({0x1017}), static_cast<std::uint64_t>(period));
  }
  EXPECT_TRUE(bench.client.complaints.empty());
}

TEST(DeviceSdoTest, ALongTextGoesDownAndComesUpInSegmentsWithTheirToggles) {
  DriveBench bench;
  for (const Transfer transfer : {Transfer::kSegmented, Transfer::kSegmentedUnsized}) {
    Bytes text = kLongText;
    for (const std::size_t size : {20U, 14U, 13U, 8U, 7U, 1U}) {
      text.resize(size);
      EXPECT_EQ(bench.write({0x2000}, text, transfer), 0U);
      EXPECT_EQ(bench.read({0x2000}).bytes, text);
    }
  }
  EXPECT_TRUE(bench.client.complaints.empty());
}

/// A request by its bytes to a drive, and the abort code of its answer.
struct Refusal {
  const char* what;
  Bytes request;
  std::uint32_t code;
};

class DeviceSdoRefusalTest : public ::testing::TestWithParam<Refusal> {};

/// The answer to a request by hand.
Bytes ask(DriveBench& bench, const Bytes& request) {
  CanFrame frame;
  frame.id = 0x605;
  frame.length = 8;
  std::copy(request.begin(), request.end(), frame.data.begin());
  bench.node().receive(frame, bench.now_ns);
  std::vector<CanFrame> answers;
  bench.node().take(answers);
  if (answers.empty()) return {};
  return {answers.back().data.begin(), answers.back().data.end()};
}

TEST_P(DeviceSdoRefusalTest, IsAnAbortWithTheObjectAndTheCode) {
  DriveBench bench;
  Bytes expected = GetParam().request;
  expected.resize(4);
  expected[0] = 0x80;
  for (const std::uint8_t byte : little_endian(GetParam().code, 4)) expected.push_back(byte);
  EXPECT_EQ(ask(bench, GetParam().request), expected) << GetParam().what;
}

INSTANTIATE_TEST_SUITE_P(
    Codes, DeviceSdoRefusalTest,
    ::testing::Values(
        Refusal{"no object", {0x40, 0xFF, 0x6F, 0x00}, 0x06020000},
        Refusal{"no object to write", {0x2F, 0x0C, 0x10, 0x00, 1}, 0x06020000},
        Refusal{"no sub-index", {0x40, 0x18, 0x10, 0x05}, 0x06090011},
        Refusal{"no sub-index of a variable", {0x40, 0x00, 0x10, 0x01}, 0x06090011},
        Refusal{"reserved sub-index of a PDO", {0x40, 0x00, 0x18, 0x04}, 0x06090011},
        Refusal{"a second watched node", {0x23, 0x16, 0x10, 0x02, 1, 0, 1, 0}, 0x06090011},
        Refusal{"read-only", {0x23, 0x00, 0x10, 0x00, 1, 2, 3, 4}, 0x06010002},
        Refusal{"read-only, before its length", {0x2F, 0x41, 0x60, 0x00, 1}, 0x06010002},
        Refusal{"read-only in segments", {0x21, 0x08, 0x10, 0x00, 9}, 0x06010002},
        Refusal{"too long", {0x2B, 0x60, 0x60, 0x00, 8, 0}, 0x06070012},
        Refusal{"too short", {0x2F, 0x40, 0x60, 0x00, 6}, 0x06070013},
        Refusal{"too long by announcement", {0x21, 0x00, 0x20, 0x00, 33}, 0x06070012},
        Refusal{"too short by announcement", {0x21, 0x85, 0x60, 0x00, 3}, 0x06070013},
        Refusal{"above its range", {0x2F, 0xC2, 0x60, 0x02, 1}, 0x06090031},
        Refusal{"below its range", {0x2F, 0xC2, 0x60, 0x02, 0xF9}, 0x06090032},
        Refusal{"zero deceleration", {0x23, 0x85, 0x60, 0x00, 0, 0, 0, 0}, 0x06090032},
        Refusal{"a quick stop it cannot", {0x2B, 0x5A, 0x60, 0x00, 3, 0}, 0x06090030},
        Refusal{"a mode it lacks", {0x2F, 0x60, 0x60, 0x00, 1}, 0x06090030},
        Refusal{"homing, which it lacks", {0x2F, 0x60, 0x60, 0x00, 6}, 0x06090030},
        Refusal{"making the SYNC", {0x23, 0x05, 0x10, 0x00, 0x80, 0, 0, 0x40}, 0x06090030},
        Refusal{"a counter of one", {0x2F, 0x19, 0x10, 0x00, 1}, 0x06090030},
        Refusal{"no error to read", {0x40, 0x03, 0x10, 0x01}, 0x08000024},
        Refusal{"a wrong signature", {0x23, 0x10, 0x10, 0x01, 's', 'a', 'v', 'f'}, 0x08000020},
        Refusal{"load is not save", {0x23, 0x10, 0x10, 0x01, 'l', 'o', 'a', 'd'}, 0x08000020},
        Refusal{"count of a valid PDO", {0x2F, 0x00, 0x1A, 0x00, 0}, 0x08000022},
        Refusal{"inhibit time of a valid PDO", {0x2B, 0x00, 0x18, 0x03, 1, 0}, 0x08000022},
        Refusal{"block upload", {0xA0, 0x00, 0x10, 0x00, 0x7F}, 0x05040001},
        Refusal{"block download", {0xC2, 0x00, 0x20, 0x00, 20}, 0x05040001},
        Refusal{"an unassigned service", {0xE0, 0x00, 0x10, 0x00}, 0x05040001}));

TEST(DeviceSdoTest, ASegmentThatBelongsToNothingNamesNoObject) {
  DriveBench bench;
  const Bytes refused = {0x80, 0, 0, 0, 0x01, 0x00, 0x04, 0x05};
  EXPECT_EQ(ask(bench, {0x60}), refused);
  EXPECT_EQ(ask(bench, {0x0F, 1, 2}), refused);
}

TEST(DeviceSdoTest, ASegmentOfTheOtherDirectionEndsTheTransfer) {
  DriveBench bench;
  static_cast<void>(ask(bench, {0x40, 0x08, 0x10, 0x00}));
  EXPECT_EQ(ask(bench, {0x00}), (Bytes{0x80, 0x08, 0x10, 0x00, 0x01, 0x00, 0x04, 0x05}));
  EXPECT_EQ(ask(bench, {0x60})[0], 0x80);
}

TEST(DeviceSdoTest, AWrongToggleAbortsAnUploadAndADownload) {
  DriveBench bench;
  static_cast<void>(ask(bench, {0x40, 0x08, 0x10, 0x00}));
  EXPECT_EQ(ask(bench, {0x60})[0], 0x00);
  EXPECT_EQ(ask(bench, {0x60}), (Bytes{0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x03, 0x05}));
  static_cast<void>(ask(bench, {0x21, 0x00, 0x20, 0x00, 20}));
  EXPECT_EQ(ask(bench, {0x10, 'a'}), (Bytes{0x80, 0x00, 0x20, 0x00, 0x00, 0x00, 0x03, 0x05}));
  EXPECT_EQ(bench.read({0x2000}).bytes, Bytes{}) << "nothing was stored";
}

TEST(DeviceSdoTest, SegmentsThatDoNotAddUpAbort) {
  DriveBench bench;
  static_cast<void>(ask(bench, {0x21, 0x00, 0x20, 0x00, 8}));
  EXPECT_EQ(ask(bench, {0x01, 'a', 'b', 'c', 'd', 'e', 'f', 'g'}),
            (Bytes{0x80, 0x00, 0x20, 0x00, 0x10, 0x00, 0x07, 0x06}));
  // More than the object takes, without announcement.
  static_cast<void>(ask(bench, {0x20, 0x17, 0x10, 0x00}));
  EXPECT_EQ(ask(bench, {0x00, 1, 2, 3, 4, 5, 6, 7}),
            (Bytes{0x80, 0x17, 0x10, 0x00, 0x12, 0x00, 0x07, 0x06}));
  static_cast<void>(ask(bench, {0x20, 0x17, 0x10, 0x00}));
  EXPECT_EQ(ask(bench, {0x0D, 1}), (Bytes{0x80, 0x17, 0x10, 0x00, 0x13, 0x00, 0x07, 0x06}));
}

TEST(DeviceSdoTest, AnUnprintableTextIsNoVisibleString) {
  DriveBench bench;
  EXPECT_EQ(bench.write({0x2000}, {'a', 0x07}), 0x06090030U);
}

TEST(DeviceSdoTest, TheClientsAbortEndsATransferAndIsNotAnswered) {
  DriveBench bench;
  static_cast<void>(ask(bench, {0x40, 0x08, 0x10, 0x00}));
  EXPECT_EQ(ask(bench, {0x80, 0x08, 0x10, 0x00, 0, 0, 0x04, 0x05}), Bytes{});
  EXPECT_EQ(ask(bench, {0x60})[0], 0x80);
}

TEST(DeviceSdoTest, ANewRequestEndsAnUnfinishedTransfer) {
  DriveBench bench;
  static_cast<void>(ask(bench, {0x40, 0x08, 0x10, 0x00}));
  EXPECT_EQ(bench.value({0x1018}), 4U);
  EXPECT_EQ(ask(bench, {0x60})[0], 0x80);
}

TEST(DeviceSdoTest, ARequestOfOtherThanEightBytesIsNoRequest) {
  DriveBench bench;
  bench.tell({0x605, {0x40, 0x00, 0x10, 0x00}});
  EXPECT_TRUE(bench.client.complaints.empty());
}

TEST(DeviceSdoTest, AWriteOnlyObjectCannotBeRead) {
  SensorBench bench;
  EXPECT_EQ(bench.read_abort({0x2003}), 0x06010001U);
  EXPECT_EQ(bench.write_u8({0x2003}, 2), 0x06090031U);
  EXPECT_EQ(bench.write_u8({0x2003}, 1), 0U);
}

TEST(DeviceSdoTest, WhatTheDriveCannotDoNowIsRefusedByItsState) {
  DriveBench bench;
  bench.configure();
  bench.enable();
  EXPECT_EQ(bench.write_u32({0x1010, 1}, 0x65766173), 0x08000022U);
  EXPECT_EQ(bench.write_u8({0x6060}, 0), 0x08000022U) << "no mode while it moves";
  EXPECT_EQ(bench.write_u8({0x6060}, 8), 0U) << "the one that it is in";
  EXPECT_EQ(bench.write_u32({0x1006}, 2000), 0U);
  EXPECT_EQ(bench.write_u8({0x1019}, 10), 0x08000022U) << "the cycle period must be 0";
}

}  // namespace
}  // namespace tenon::sim
