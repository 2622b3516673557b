// The kernel's CAN sockets as a bus, over a virtual interface.

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "hw/can/socketcan_bus.h"
#include "shared/system/monotonic_clock.h"
#include "tests/socketcan/interfaces.h"

namespace tenon::socketcan {
namespace {

using hw::SocketcanBus;

constexpr std::uint32_t kAnyBitrate_bps = 1'000'000;

class SocketcanTransport : public testing::Test {
 protected:
  VirtualInterface vcan{"vcan0"};
  SocketcanBus a{"vcan0", kAnyBitrate_bps, 1};
  SocketcanBus b{"vcan0", kAnyBitrate_bps, 1};
  ReceivedFrame received;
};

TEST_F(SocketcanTransport, EveryKindOfFrameArrivesWholeInOrderAndNotAtItsSender) {
  const std::vector<CanFrame> kinds = {
      {0x080, false, false, 0, {}},
      {0x000, false, false, 2, {0x01, 0x00}},
      {0x7FF, false, false, 8, {1, 2, 3, 4, 5, 6, 7, 0xFF}},
      {0x123, true, false, 3, {9, 8, 7}},  // 29 bits although 11 would do
      {0x1FFFFFFF, true, false, 8, {0xFF, 0, 0xFF, 0, 0xFF, 0, 0xFF, 0}},
      {0x181, false, true, 8, {}},
      {0x12345678, true, true, 1, {}},
  };
  for (const CanFrame& frame : kinds) EXPECT_EQ(a.send(frame), SendResult::kSent);
  for (const CanFrame& frame : kinds) {
    ASSERT_TRUE(receive_soon(b, received));
    EXPECT_EQ(received.frame, frame);
  }
  EXPECT_FALSE(b.receive(received));
  EXPECT_FALSE(a.receive(received)) << "a bus does not hear itself";
  EXPECT_EQ(a.status().sent, kinds.size());
  EXPECT_EQ(b.status().received, kinds.size());
}

TEST_F(SocketcanTransport, ReceiveTimesAreMonotonicTimeAndNeverStepBack) {
  // Between sending and reading, but for the conversion from the kernel's clock.
  constexpr std::int64_t kConversion_ns = 50'000'000;
  std::int64_t previous_ns = monotonic_now_ns() - kConversion_ns;
  for (unsigned i = 0; i < 200; ++i) ASSERT_EQ(a.send(numbered(i)), SendResult::kSent);
  for (unsigned i = 0; i < 200; ++i) {
    ASSERT_TRUE(receive_soon(b, received));
    EXPECT_GE(received.time_ns, previous_ns);
    previous_ns = received.time_ns;
  }
  EXPECT_LE(previous_ns, monotonic_now_ns() + kConversion_ns);
}

TEST_F(SocketcanTransport, AFrameThatNobodyReadsInTimeIsCountedAsAnOverrun) {
  constexpr unsigned kMany = 5000;  // the kernel keeps some hundreds for a reader
  for (unsigned i = 0; i < kMany; ++i) ASSERT_EQ(a.send(numbered(i)), SendResult::kSent);
  const std::size_t kept = drain(b).size();
  EXPECT_LT(kept, kMany);
  ASSERT_EQ(a.send(numbered(kMany)), SendResult::kSent);
  ASSERT_TRUE(receive_soon(b, received));
  EXPECT_EQ(received.frame, numbered(kMany));
  EXPECT_EQ(b.status().overruns, kMany - kept);
}

// interface  up            down                up
// a sends    1: ok         2: down                     3: ok
// b receives                       1, nothing     up       3
TEST_F(SocketcanTransport, AnInterfaceThatGoesDownIsDownUntilItIsUpAgain) {
  ASSERT_EQ(a.send(numbered(1)), SendResult::kSent);
  run("ip link set vcan0 down");
  EXPECT_EQ(a.send(numbered(2)), SendResult::kDown);
  EXPECT_FALSE(a.status().up);
  EXPECT_EQ(a.status().send_failures, 1U);
  EXPECT_FALSE(b.receive(received));
  EXPECT_FALSE(b.status().up) << "a listener notices, too";
  ASSERT_TRUE(b.receive(received));
  EXPECT_EQ(received.frame, numbered(1)) << "what came before can still be read";
  EXPECT_FALSE(b.receive(received));
  EXPECT_FALSE(b.status().up) << "and does not make the interface up";

  run("ip link set vcan0 up");
  EXPECT_FALSE(b.receive(received));
  EXPECT_TRUE(b.status().up) << "and without sending";
  EXPECT_EQ(a.send(numbered(3)), SendResult::kSent);
  EXPECT_TRUE(a.status().up);
  ASSERT_TRUE(receive_soon(b, received));
  EXPECT_EQ(received.frame, numbered(3)) << "the refused frame does not come late";
}

TEST_F(SocketcanTransport, AnInterfaceThatIsRemovedStaysDownEvenIfAnotherTakesItsName) {
  run("ip link del vcan0");
  EXPECT_FALSE(b.receive(received));
  EXPECT_FALSE(b.status().up);
  EXPECT_EQ(a.send(numbered(1)), SendResult::kDown);

  const VirtualInterface another("vcan0");
  EXPECT_FALSE(b.receive(received));
  EXPECT_FALSE(b.status().up);
  EXPECT_EQ(a.send(numbered(2)), SendResult::kDown);
  EXPECT_FALSE(a.status().up);
}

// Frames as drivers make them, sent by cansend: the class in the identifier, details in the bytes
// (linux/can/error.h).
TEST_F(SocketcanTransport, ErrorFramesReachTheStatusAndNotTheReader) {
  run("cansend vcan0 20000004#0020000000000000");  // controller: transmitter is error-passive
  EXPECT_FALSE(b.receive(received));
  EXPECT_TRUE(b.status().error_passive);
  run("cansend vcan0 20000040#0000000000000000");  // bus-off
  EXPECT_FALSE(b.receive(received));
  EXPECT_TRUE(b.status().bus_off);
  run("cansend vcan0 20000100#0000000000000000");  // restarted
  EXPECT_FALSE(b.receive(received));
  EXPECT_FALSE(b.status().bus_off);
  EXPECT_FALSE(b.status().error_passive);
  run("cansend vcan0 20000020#0000000000000000");  // no acknowledge
  EXPECT_FALSE(b.receive(received));
  EXPECT_EQ(b.status().error_frames, 4U);
  EXPECT_EQ(b.status().received, 0U);
}

TEST_F(SocketcanTransport, BusOffEndsWhenTheInterfaceIsTakenDownAndUp) {
  run("cansend vcan0 20000040#0000000000000000");
  EXPECT_FALSE(b.receive(received));
  ASSERT_TRUE(b.status().bus_off);
  run("ip link set vcan0 down");
  EXPECT_FALSE(b.receive(received));
  EXPECT_TRUE(b.status().bus_off);
  run("ip link set vcan0 up");
  EXPECT_FALSE(b.receive(received));
  EXPECT_FALSE(b.status().bus_off);
  EXPECT_TRUE(b.status().up);
}

}  // namespace
}  // namespace tenon::socketcan
