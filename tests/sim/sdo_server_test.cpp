// The SDO server against frames written out by hand from CiA 301.

#include "sim/cell/canopen/sdo_server.h"

#include <gtest/gtest.h>

#include "shared/canopen/constants.h"

namespace tenon::sim {
namespace {

using Message = SdoServer::Message;

class SdoServerTest : public ::testing::Test {
 protected:
  SdoServerTest() {
    using enum DataType;
    dictionary.add(object_id(0x1000), {.type = kU32, .value = 0x00020192});
    dictionary.add(object_id(0x1008), {.type = kText, .text = "tenon drive"});
    dictionary.add(object_id(0x1017), {.type = kU16, .access = Access::kReadWrite});
    dictionary.add(object_id(0x1018), {.type = kU8, .value = 4});
    dictionary.add(object_id(0x2000),
                   {.type = kI8, .access = Access::kReadWrite, .low = -5, .high = 7});
    dictionary.add(object_id(0x2001), {.type = kU32, .access = Access::kWriteOnly});
    dictionary.add(object_id(0x2002),
                   {.type = kU8, .access = Access::kReadWrite, .on_write = [](std::int64_t) {
                      return std::uint32_t{0x08000022};
                    }});
  }

  Message ask(const Message& request) { return *server.answer(request); }

  ObjectDictionary dictionary;
  SdoServer server{dictionary};
};

TEST_F(SdoServerTest, ExpeditedUploadCarriesTheValueAndItsSize) {
  EXPECT_EQ(ask({0x40, 0x00, 0x10, 0x00}),
            (Message{0x43, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0x00}));
  EXPECT_EQ(ask({0x40, 0x18, 0x10, 0x00}), (Message{0x4F, 0x18, 0x10, 0x00, 0x04}));
}

TEST_F(SdoServerTest, ExpeditedDownloadWrites) {
  EXPECT_EQ(ask({0x2B, 0x17, 0x10, 0x00, 0x64, 0x00}), (Message{0x60, 0x17, 0x10, 0x00}));
  EXPECT_EQ(dictionary.value(object_id(0x1017)), 100);
  // Size not indicated: the object's own.
  EXPECT_EQ(ask({0x22, 0x17, 0x10, 0x00, 0xC8, 0x00}), (Message{0x60, 0x17, 0x10, 0x00}));
  EXPECT_EQ(dictionary.value(object_id(0x1017)), 200);
  EXPECT_EQ(ask({0x2F, 0x00, 0x20, 0x00, 0xFB}), (Message{0x60, 0x00, 0x20, 0x00}));
  EXPECT_EQ(dictionary.value(object_id(0x2000)), -5);
}

TEST_F(SdoServerTest, ALongTextComesInSegmentsWithToggle) {
  EXPECT_EQ(ask({0x40, 0x08, 0x10, 0x00}), (Message{0x41, 0x08, 0x10, 0x00, 11}));
  EXPECT_EQ(ask({0x60}), (Message{0x00, 't', 'e', 'n', 'o', 'n', ' ', 'd'}));
  EXPECT_EQ(ask({0x70}), (Message{0x17, 'r', 'i', 'v', 'e'}));
  // Finished: another segment has no transfer to belong to.
  EXPECT_EQ(ask({0x60})[0], 0x80);
}

TEST_F(SdoServerTest, SegmentedDownloadWritesWithTheLastSegment) {
  EXPECT_EQ(ask({0x21, 0x17, 0x10, 0x00, 2}), (Message{0x60, 0x17, 0x10, 0x00}));
  EXPECT_EQ(ask({0x0C, 0x34}), (Message{0x20}));
  EXPECT_EQ(dictionary.value(object_id(0x1017)), 0);
  EXPECT_EQ(ask({0x1D, 0x12}), (Message{0x30}));
  EXPECT_EQ(dictionary.value(object_id(0x1017)), 0x1234);
}

TEST_F(SdoServerTest, AWrongToggleAborts) {
  static_cast<void>(ask({0x40, 0x08, 0x10, 0x00}));
  EXPECT_EQ(ask({0x70}), (Message{0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x03, 0x05}));
  static_cast<void>(ask({0x21, 0x17, 0x10, 0x00, 2}));
  EXPECT_EQ(ask({0x1D, 0x12}), (Message{0x80, 0x17, 0x10, 0x00, 0x00, 0x00, 0x03, 0x05}));
}

struct Refusal {
  Message request;
  std::uint32_t code;
};

class SdoRefusalTest : public SdoServerTest, public ::testing::WithParamInterface<Refusal> {};

TEST_P(SdoRefusalTest, IsAnsweredByItsAbortCode) {
  const Message answer = ask(GetParam().request);
  EXPECT_EQ(answer[0], 0x80);
  EXPECT_EQ(answer[1], GetParam().request[1]);
  EXPECT_EQ(answer[2], GetParam().request[2]);
  const std::uint32_t code =
      static_cast<std::uint32_t>(answer[4]) | static_cast<std::uint32_t>(answer[5]) << 8 |
      static_cast<std::uint32_t>(answer[6]) << 16 | static_cast<std::uint32_t>(answer[7]) << 24;
  EXPECT_EQ(code, GetParam().code);
}

INSTANTIATE_TEST_SUITE_P(
    Codes, SdoRefusalTest,
    ::testing::Values(Refusal{{0x40, 0x99, 0x60, 0x00}, 0x06020000},              // no object
                      Refusal{{0x40, 0x18, 0x10, 0x09}, 0x06090011},              // no sub-index
                      Refusal{{0x40, 0x01, 0x20, 0x00}, 0x06010001},              // write only
                      Refusal{{0x23, 0x00, 0x10, 0x00, 1, 2, 3, 4}, 0x06010002},  // read only
                      Refusal{{0x2F, 0x17, 0x10, 0x00, 1}, 0x06070013},           // too short
                      Refusal{{0x23, 0x17, 0x10, 0x00, 1, 0, 0, 0}, 0x06070012},  // too long
                      Refusal{{0x21, 0x17, 0x10, 0x00, 9}, 0x06070012},           // announced
                      Refusal{{0x2F, 0x00, 0x20, 0x00, 8}, 0x06090031},           // above range
                      Refusal{{0x2F, 0x00, 0x20, 0x00, 0xFA}, 0x06090032},        // below range
                      Refusal{{0x2F, 0x02, 0x20, 0x00, 1}, 0x08000022},           // the hook's own
                      Refusal{{0xA0, 0x00, 0x10, 0x00}, 0x05040001},              // block upload
                      Refusal{{0xC0, 0x00, 0x10, 0x00}, 0x05040001}));            // block download

TEST_F(SdoServerTest, AnAbortIsNotAnswered) {
  static_cast<void>(ask({0x40, 0x08, 0x10, 0x00}));
  EXPECT_FALSE(server.answer({0x80, 0x08, 0x10, 0x00}));
  EXPECT_EQ(ask({0x60})[0], 0x80);
}

TEST_F(SdoServerTest, ALengthThatContradictsItsAnnouncementAborts) {
  static_cast<void>(ask({0x21, 0x17, 0x10, 0x00, 2}));
  EXPECT_EQ(ask({0x0D, 0x34}), (Message{0x80, 0x17, 0x10, 0x00, 0x10, 0x00, 0x07, 0x06}));
}

}  // namespace
}  // namespace tenon::sim
