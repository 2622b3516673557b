// Two controllers on one bus through the kernel's own driver: can0 and can1 of the guest.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <vector>

#include "hw/can/socketcan_bus.h"
#include "tests/socketcan/interfaces.h"

namespace tenon::socketcan {
namespace {

using hw::SocketcanBus;

CanFrame drawn(std::mt19937& random) {
  CanFrame frame;
  frame.extended = random() % 4 == 0;
  frame.remote = random() % 8 == 0;
  frame.id = static_cast<std::uint32_t>(random()) & (frame.extended ? 0x1FFFFFFF : 0x7FF);
  if (frame.remote) return frame;  // of length 0: others derange the emulator's receive memory
  frame.length = static_cast<std::uint8_t>(random() % 9);
  for (std::size_t i = 0; i < frame.length; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(random());
  }
  return frame;
}

class Sja1000 : public testing::Test {
 protected:
  Controllers controllers{kMbit_bps};
  std::array<SocketcanBus, 2> ends{SocketcanBus{"can0", kMbit_bps, 1},
                                   SocketcanBus{"can1", kMbit_bps, 1}};
  ReceivedFrame received;
};

TEST_F(Sja1000, FramesOfEveryKindCrossTheBusInBothDirections) {
  std::mt19937 random(7);
  for (int i = 0; i < 1000; ++i) {
    SocketcanBus& from = ends[i % 2];
    SocketcanBus& to = ends[1 - i % 2];
    const CanFrame frame = drawn(random);
    ASSERT_EQ(from.send(frame), SendResult::kSent);
    ASSERT_TRUE(receive_soon(to, received)) << i;
    ASSERT_EQ(received.frame, frame) << i;
  }
  for (SocketcanBus& end : ends) {
    EXPECT_FALSE(end.receive(received)) << "a bus does not hear itself";
    EXPECT_EQ(end.status().sent, 500U);
    EXPECT_EQ(end.status().received, 500U);
    EXPECT_EQ(end.status().error_frames, 0U);
  }
}

// can0 sends     0                 1                       2 3 4 5 6      7 ...
//                in the controller taken out for the next  queue of 5     refused
TEST_F(Sja1000, AFullTransmitQueueIsAnotherResultThanABusThatIsDown) {
  run("ip link set can0 txqueuelen 5");
  unsigned taken = 0;
  {
    const InterruptHeld busy("can0");  // the first frame never seems to leave
    while (taken < 100 && ends[0].send(numbered(taken)) == SendResult::kSent) ++taken;
    EXPECT_EQ(taken, 7U);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(ends[0].send(numbered(99)), SendResult::kQueueFull);
    EXPECT_EQ(ends[0].status().send_failures, 4U);
    EXPECT_EQ(ends[0].status().sent, taken);
    EXPECT_TRUE(ends[0].status().up);
  }
  for (unsigned i = 0; i < taken; ++i) {
    ASSERT_TRUE(receive_soon(ends[1], received)) << i;
    EXPECT_EQ(received.frame, numbered(i));
  }
  ASSERT_EQ(ends[0].send(numbered(50)), SendResult::kSent) << "there is room again";
  ASSERT_TRUE(receive_soon(ends[1], received));
  EXPECT_EQ(received.frame, numbered(50)) << "what was refused does not come late";
}

TEST_F(Sja1000, FloodedEveryFrameIsReceivedOrCounted) {
  constexpr unsigned kMany = 3000;
  run("ip link set can0 txqueuelen 2");
  unsigned full = 0;
  std::uint64_t count = 0;
  for (unsigned i = 0; i < kMany; ++i) {
    full += ends[0].send(numbered(i)) == SendResult::kQueueFull;
    while (ends[1].receive(received)) ++count;
  }
  count += drain(ends[1]).size();
  const CanBusStatus sender = ends[0].status();
  EXPECT_EQ(sender.sent + full, kMany);
  EXPECT_EQ(sender.send_failures, full);
  EXPECT_EQ(ends[1].status().received, count);
  // An overrun of the controller is one report of any number of frames.
  const std::uint64_t lost = sender.sent - count;
  EXPECT_EQ(lost == 0, ends[1].status().overruns == 0) << lost << " frames lost";
}

TEST_F(Sja1000, WhatTheControllerItselfLosesIsReportedByItsDriver) {
  {
    const InterruptHeld deaf("can1");  // its memory has room for a few frames
    for (unsigned i = 0; i < 50; ++i) ASSERT_EQ(ends[0].send(numbered(i)), SendResult::kSent);
    EXPECT_TRUE(drain(ends[0]).empty());
  }
  const std::vector<CanFrame> kept = drain(ends[1]);
  ASSERT_FALSE(kept.empty());
  EXPECT_LT(kept.size(), 50U);
  for (unsigned i = 0; i < kept.size(); ++i) EXPECT_EQ(kept[i], numbered(i));
  EXPECT_GE(ends[1].status().error_frames, 1U);
  EXPECT_GE(ends[1].status().overruns, 1U);
  EXPECT_FALSE(ends[1].status().bus_off);

  ASSERT_EQ(ends[0].send(numbered(99)), SendResult::kSent);
  ASSERT_TRUE(receive_soon(ends[1], received));
  EXPECT_EQ(received.frame, numbered(99));
}

TEST_F(Sja1000, AControllerThatGoesDownInMidTrafficComesBack) {
  for (unsigned i = 0; i < 10; ++i) ASSERT_EQ(ends[0].send(numbered(i)), SendResult::kSent);
  run("ip link set can0 down");
  EXPECT_EQ(ends[0].send(numbered(10)), SendResult::kDown);
  EXPECT_FALSE(ends[0].status().up);
  EXPECT_LE(drain(ends[1]).size(), 10U);
  EXPECT_TRUE(ends[1].status().up) << "the other one is";

  run("ip link set can0 up");
  ASSERT_EQ(ends[0].send(numbered(11)), SendResult::kSent);
  EXPECT_TRUE(ends[0].status().up);
  ASSERT_TRUE(receive_soon(ends[1], received));
  EXPECT_EQ(received.frame, numbered(11));
  ASSERT_EQ(ends[1].send(numbered(12)), SendResult::kSent);
  ASSERT_TRUE(receive_soon(ends[0], received));
  EXPECT_EQ(received.frame, numbered(12));
}

TEST_F(Sja1000, AControllerThatIsUnpluggedIsDown) {
  const auto device = std::filesystem::canonical("/sys/class/net/can1/device");
  std::ofstream(device / "remove") << 1;
  EXPECT_FALSE(ends[1].receive(received));
  EXPECT_FALSE(ends[1].status().up);
  EXPECT_EQ(ends[1].send(numbered(1)), SendResult::kDown);

  std::ofstream("/sys/bus/pci/rescan") << 1;
  run("ip link set can1 up type can bitrate 1000000");
  EXPECT_EQ(ends[1].send(numbered(2)), SendResult::kDown) << "it was another one";
  SocketcanBus again("can1", kMbit_bps, 1);
  ASSERT_EQ(ends[0].send(numbered(3)), SendResult::kSent);
  ASSERT_TRUE(receive_soon(again, received));
  EXPECT_EQ(received.frame, numbered(3));
}

}  // namespace
}  // namespace tenon::socketcan
