// The client of the tests must see what a server does wrong, or a walk without complaints says
// nothing.

#include <gtest/gtest.h>

#include "tests/support/canopen_client.h"

namespace tenon::tests {
namespace {

WireFrame answer(Bytes data) {
  data.resize(8);
  return {0x585, data};
}

TEST(CanopenClientTest, ReadsExpeditedAndInSegments) {
  CanopenClient client(5);
  EXPECT_EQ(client.begin_read(0x1017, 0, 0).data, (Bytes{0x40, 0x17, 0x10, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(client.receive(answer({0x4B, 0x17, 0x10, 0, 0x34, 0x12}), 0));
  EXPECT_EQ(unsigned_of(client.answer()->bytes), 0x1234U);
  static_cast<void>(client.begin_read(0x1008, 0, 0));
  EXPECT_EQ(client.receive(answer({0x41, 0x08, 0x10, 0, 8}), 0)->data[0], 0x60);
  EXPECT_EQ(client.receive(answer({0x00, 'a', 'b', 'c', 'd', 'e', 'f', 'g'}), 0)->data[0], 0x70);
  EXPECT_FALSE(client.receive(answer({0x1D, 'h'}), 0));
  EXPECT_EQ(client.answer()->bytes, (Bytes{'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'}));
  EXPECT_TRUE(client.complaints.empty());
}

TEST(CanopenClientTest, WritesExpeditedAndInSegments) {
  CanopenClient client(5);
  EXPECT_EQ(
      client.begin_write(0x1017, 0, {0x34, 0x12}, CanopenClient::Transfer::kExpedited, 0).data,
      (Bytes{0x2B, 0x17, 0x10, 0, 0x34, 0x12, 0, 0}));
  EXPECT_FALSE(client.receive(answer({0x60, 0x17, 0x10}), 0));
  EXPECT_EQ(client.answer()->abort, 0U);
  const Bytes text = {'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'};
  EXPECT_EQ(client.begin_write(0x2000, 0, text, CanopenClient::Transfer::kSegmented, 0).data,
            (Bytes{0x21, 0x00, 0x20, 0, 8, 0, 0, 0}));
  EXPECT_EQ(client.receive(answer({0x60, 0x00, 0x20}), 0)->data,
            (Bytes{0x00, 'a', 'b', 'c', 'd', 'e', 'f', 'g'}));
  EXPECT_EQ(client.receive(answer({0x20}), 0)->data, (Bytes{0x1D, 'h', 0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(client.receive(answer({0x30}), 0));
  EXPECT_EQ(client.answer()->abort, 0U);
  EXPECT_TRUE(client.complaints.empty());
}

TEST(CanopenClientTest, ComplainsAboutAServerThatErrs) {
  const auto complaints_about = [](const Bytes& first, const Bytes& second) {
    CanopenClient client(5);
    static_cast<void>(client.begin_read(0x1008, 0, 0));
    static_cast<void>(client.receive(answer(first), 0));
    if (!second.empty()) static_cast<void>(client.receive(answer(second), 0));
    return client.complaints.size();
  };
  const Bytes good = {0x41, 0x08, 0x10, 0, 2};
  EXPECT_EQ(complaints_about(good, {0x0B, 'a', 'b'}), 0U);
  EXPECT_EQ(complaints_about({0x41, 0x09, 0x10, 0, 2}, {}), 1U) << "another object";
  EXPECT_EQ(complaints_about({0x61, 0x08, 0x10, 0, 2}, {}), 1U) << "another service";
  EXPECT_EQ(complaints_about(good, {0x1B, 'a', 'b'}), 1U) << "another toggle";
  EXPECT_EQ(complaints_about(good, {0x0D, 'a'}), 1U) << "another size";
  EXPECT_EQ(complaints_about({0x4B, 0x08, 0x10, 0, 1, 2}, {0x4B, 0x08, 0x10, 0, 1, 2}), 1U)
      << "an answer too many";
}

TEST(CanopenClientTest, GivesASilentServerHalfASecond) {
  CanopenClient client(5);
  static_cast<void>(client.begin_read(0x1000, 0, 0));
  EXPECT_FALSE(client.advance(500'000'000));
  EXPECT_EQ(client.advance(500'000'001)->data, (Bytes{0x80, 0x00, 0x10, 0, 0, 0, 0x04, 0x05}));
  EXPECT_EQ(client.answer()->abort, 0x05040000U);
}

}  // namespace
}  // namespace tenon::tests
