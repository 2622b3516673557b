// Who is on a bus, by requests of 1000h and literal answers.

#include "hw/canopen/node_scan.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "sim/cell/bus/virtual_bus.h"

namespace tenon::hw::canopen {
namespace {

class Scanned : public ::testing::Test {
 protected:
  /// Runs the scan; `answer` is called every millisecond with its time.
  template <typename Answer>
  void run(Answer answer) {
    for (; !scan.done(now_ns); now_ns += 1'000'000) {
      ASSERT_LT(now_ns, 3'000'000'000) << "it ends";
      scan.update(now_ns, master);
      ReceivedFrame received;
      while (others.receive(received)) requests.push_back(received.frame);
      answer(now_ns);
      while (master.receive(received)) scan.process(received.frame);
    }
  }
  void send(const CanFrame& frame) { (void)others.send(frame); }

  sim::VirtualBus bus{{.bitrate_bps = 0}};
  CanBus& master = bus.attach();
  CanBus& others = bus.attach();
  NodeScan scan;
  std::int64_t now_ns = 5;
  std::vector<CanFrame> requests;
};

constexpr CanFrame kDrive3 = {
    0x583, false, false, 8, {0x43, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0x00}};

TEST_F(Scanned, AsksEveryNodeOnceForItsDeviceType) {
  run([](std::int64_t) {});
  ASSERT_EQ(requests.size(), 127u);
  EXPECT_EQ(requests.front(), (CanFrame{0x601, false, false, 8, {0x40, 0x00, 0x10, 0x00}}));
  EXPECT_EQ(requests.back().id, 0x67Fu);
  EXPECT_EQ(scan.count(), 0);
}

//  requests 1..127      hearing out
//  |----- 0.25 s -----|------ 1 s ------|
//                                    ^ node 3
TEST_F(Scanned, HearsOutADeviceThatTakesASecond) {
  bool sent = false;
  run([&](std::int64_t at_ns) {
    if (sent || at_ns < 1'200'000'000) return;
    sent = true;
    send(kDrive3);
  });
  ASSERT_TRUE(sent);
  EXPECT_EQ(scan.count(), 1);
  EXPECT_EQ(describe(3, scan.found(3), 0xFB),
            "node   3  CiA 402 drive, device type 0x00020192, vendor 0x000000FB");
}

TEST_F(Scanned, TwoAnswersToOneRequestAreTwoDevices) {
  int sent = 0;
  run([&](std::int64_t) {
    if (sent++ < 2) send(kDrive3);
  });
  EXPECT_EQ(scan.found(3).answers, 2u);
  EXPECT_TRUE(scan.doubled());
}

TEST_F(Scanned, WhatOthersAskIsNoAnswerToIt) {
  bool sent = false;
  run([&](std::int64_t) {
    if (sent) return;
    sent = true;
    send(kDrive3);
    send({0x583,
          false,
          false,
          8,
          {0x4B, 0x41, 0x60, 0x00, 0x37, 0x02}});  // 6041h, of another master
    send({0x583, false, false, 4, {0x43, 0x00, 0x10, 0x00}});
    send({0x703, false, false, 1, {0x7F}});
  });
  EXPECT_EQ(scan.found(3).answers, 1u);
  EXPECT_FALSE(scan.doubled());
}

TEST_F(Scanned, WhoRefusesIsThereAndHasNoDeviceType) {
  bool sent = false;
  run([&](std::int64_t) {
    if (!sent) send({0x585, false, false, 8, {0x80, 0x00, 0x10, 0x00, 0x00, 0x00, 0x02, 0x06}});
    sent = true;
  });
  EXPECT_EQ(scan.count(), 1);
  EXPECT_EQ(describe(5, scan.found(5), std::nullopt),
            "node   5  device type refused (1000h), vendor not said (1018h:1)");
}

}  // namespace
}  // namespace tenon::hw::canopen
