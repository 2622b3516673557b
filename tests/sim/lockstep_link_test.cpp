// The two links of a lockstep: over a virtual bus, and over ends of a bus that is not ours.

#include <gtest/gtest.h>

#include <cstdint>

#include "sim/cell/bus/frame_bits.h"
#include "sim/cell/bus/virtual_bus.h"
#include "sim/cell/lockstep/foreign_link.h"
#include "sim/cell/lockstep/virtual_link.h"
#include "tests/sim/literal_client.h"

namespace tenon::sim {
namespace {

constexpr std::int64_t kCycle_ns = 2'000'000;

CanFrame one_byte(std::uint32_t id) { return {id, false, false, 1, {7}}; }

TEST(VirtualLink, TimeStopsAtEachArrival) {
  VirtualLink link({.bitrate_bps = 1'000'000}, 127);
  EXPECT_EQ(link.advance(kCycle_ns), kCycle_ns) << "nothing to wait for";
  ASSERT_EQ(link.master().send(one_byte(0x201)), SendResult::kSent);
  EXPECT_TRUE(link.from_master());
  const std::int64_t end_ns = kCycle_ns + 1000 * classic_frame_bits(one_byte(0x201)).nominal;
  EXPECT_EQ(link.advance(2 * kCycle_ns), end_ns);
  EXPECT_TRUE(link.at_devices());
  EXPECT_FALSE(link.at_master());
  EXPECT_FALSE(link.from_master());
  EXPECT_EQ(link.advance(2 * kCycle_ns), 2 * kCycle_ns);
}

/// Two sockets on somebody else's bus, as it were.
struct Foreign {
  VirtualBus bus{{.bitrate_bps = 0}};
  CanBus& first = bus.attach();
  CanBus& second = bus.attach();
  ForeignLink link{first, second, 1'000'000};
};

TEST(ForeignLink, FramesArriveWithoutTimeAndTimeGoesOnWhenTheBusIsQuiet) {
  Foreign foreign;
  ForeignLink& link = foreign.link;
  ASSERT_EQ(link.master().send(one_byte(0x080)), SendResult::kSent);
  EXPECT_TRUE(link.from_master());
  EXPECT_EQ(link.advance(kCycle_ns), 0);
  ASSERT_TRUE(link.at_devices());
  EXPECT_FALSE(link.from_master());
  ReceivedFrame received;
  ASSERT_TRUE(link.devices().receive(received));
  EXPECT_EQ(received.frame, one_byte(0x080));
  EXPECT_EQ(received.time_ns, 0) << "virtual time";
  ASSERT_EQ(link.devices().send(one_byte(0x181)), SendResult::kSent);
  EXPECT_EQ(link.advance(kCycle_ns), 0);
  EXPECT_TRUE(link.at_master());
  EXPECT_EQ(link.advance(kCycle_ns), kCycle_ns);
  EXPECT_EQ(link.lost(), 0U);
}

TEST(ForeignLink, WhatASideSentLeavesWhenItIsFlushedAndWhenTimeGoesOn) {
  LiteralBus first;
  LiteralBus second;
  ForeignLink link(first, second, 1'000'000);
  link.master().flush();
  EXPECT_EQ(first.flushes, 1);
  EXPECT_EQ(second.flushes, 0);
  (void)link.advance(kCycle_ns);
  EXPECT_EQ(first.flushes, 2);
  EXPECT_EQ(second.flushes, 1);
}

TEST(ForeignLink, AFrameThatDoesNotComeIsLostAndNoHang) {
  Foreign foreign;
  foreign.bus.set_bus_off(1, true);  // the other socket hears nothing
  ASSERT_EQ(foreign.link.master().send(one_byte(0x080)), SendResult::kSent);
  EXPECT_EQ(foreign.link.advance(kCycle_ns), kCycle_ns);
  EXPECT_EQ(foreign.link.lost(), 1U);
  EXPECT_FALSE(foreign.link.from_master());
}

TEST(ForeignLink, FramesOfOthersPassToo) {
  Foreign foreign;
  CanBus& stranger = foreign.bus.attach();
  ASSERT_EQ(stranger.send(one_byte(0x601)), SendResult::kSent);
  EXPECT_EQ(foreign.link.advance(kCycle_ns), 0);
  EXPECT_TRUE(foreign.link.at_master());
  EXPECT_TRUE(foreign.link.at_devices());
  EXPECT_EQ(foreign.link.advance(kCycle_ns), kCycle_ns);
  EXPECT_EQ(foreign.link.lost(), 0U);
}

}  // namespace
}  // namespace tenon::sim
