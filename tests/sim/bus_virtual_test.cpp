// The virtual bus: who sends when, what arrives when, what happens on errors. 1 Mbit/s, so that a
// bit is a microsecond.

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "sim/cell/bus/frame_bits.h"
#include "sim/cell/bus/virtual_bus.h"

namespace tenon::sim {
namespace {

constexpr std::int64_t kBit_ns = 1000;

CanFrame frame_of(std::uint32_t id, std::uint8_t value = 0) {
  return {id, false, false, 1, {value}};
}

std::int64_t length_ns(const CanFrame& frame) {
  return kBit_ns * classic_frame_bits(frame).nominal;
}

std::vector<ReceivedFrame> drain(CanBus& end) {
  std::vector<ReceivedFrame> frames;
  for (ReceivedFrame received; end.receive(received);) frames.push_back(received);
  return frames;
}

std::vector<std::uint32_t> identifiers(const std::vector<ReceivedFrame>& frames) {
  std::vector<std::uint32_t> ids;
  for (const ReceivedFrame& received : frames) ids.push_back(received.frame.id);
  return ids;
}

TEST(VirtualBus, AFrameArrivesAtAllOtherEndsAtItsEnd) {
  VirtualBus bus({});
  CanBus& a = bus.attach();
  CanBus& b = bus.attach();
  CanBus& c = bus.attach();
  bus.advance(5'000);
  ASSERT_EQ(a.send(frame_of(0x201, 7)), SendResult::kSent);
  const std::int64_t end_ns = 5'000 + length_ns(frame_of(0x201, 7));
  EXPECT_EQ(bus.next_event_ns(), end_ns);
  bus.advance(end_ns - 1);
  EXPECT_TRUE(drain(b).empty());
  bus.advance(end_ns);
  for (CanBus* end : {&b, &c}) {
    const auto frames = drain(*end);
    ASSERT_EQ(frames.size(), 1u);
    EXPECT_EQ(frames[0].frame, frame_of(0x201, 7));
    EXPECT_EQ(frames[0].time_ns, end_ns);
  }
  EXPECT_TRUE(drain(a).empty());
  EXPECT_EQ(bus.next_event_ns(), VirtualBus::kNever_ns);
}

// time  0        80      160 us
// A     300 ────┐
// B     200     |arbitration: 100 (C), 200 (B), then A's second, 400
// C     100     |
TEST(VirtualBus, TheLowestIdentifierWinsAtEachIdleInstantAndAnEndSendsInOrder) {
  VirtualBus bus({});
  CanBus& a = bus.attach();
  CanBus& b = bus.attach();
  CanBus& c = bus.attach();
  CanBus& listener = bus.attach();
  ASSERT_EQ(a.send(frame_of(0x300)), SendResult::kSent);
  ASSERT_EQ(a.send(frame_of(0x050)), SendResult::kSent);  // behind 300h, in a FIFO
  bus.advance(10'000);                                    // 300h is on the wire
  ASSERT_EQ(b.send(frame_of(0x200)), SendResult::kSent);
  ASSERT_EQ(c.send(frame_of(0x100)), SendResult::kSent);
  bus.advance(1'000'000);
  const auto frames = drain(listener);
  EXPECT_EQ(identifiers(frames), (std::vector<std::uint32_t>{0x300, 0x050, 0x100, 0x200}));
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].time_ns - frames[i - 1].time_ns, 3 * kBit_ns + length_ns(frames[i].frame));
  }
}

TEST(VirtualBus, FramesOfTheSameInstantArbitrateInWhateverOrderTheyWereSent) {
  VirtualBus bus({});
  CanBus& a = bus.attach();
  CanBus& b = bus.attach();
  CanBus& listener = bus.attach();
  ASSERT_EQ(a.send(frame_of(0x300)), SendResult::kSent);
  (void)bus.next_event_ns();
  bus.advance(0);
  ASSERT_EQ(b.send(frame_of(0x100)), SendResult::kSent);
  bus.advance(1'000'000);
  EXPECT_EQ(identifiers(drain(listener)), (std::vector<std::uint32_t>{0x100, 0x300}));
}

TEST(VirtualBus, AnEndOfSeveralNodesSendsItsLowestIdentifierFirst) {
  VirtualBus bus({});
  CanBus& nodes = bus.attach({.order = VirtualBus::Order::kByIdentifier});
  CanBus& listener = bus.attach();
  for (const std::uint32_t id : {0x703u, 0x191u, 0x181u, 0x190u, 0x191u}) {
    ASSERT_EQ(nodes.send(frame_of(id)), SendResult::kSent);
  }
  bus.advance(1'000'000);
  EXPECT_EQ(identifiers(drain(listener)),
            (std::vector<std::uint32_t>{0x181, 0x190, 0x191, 0x191, 0x703}));
}

TEST(VirtualBus, ArbitrationFollowsTheBitsOnTheWire) {
  // Of equal first 11 bits: data before remote, 11 bits before 29 (SRR and IDE are recessive).
  VirtualBus bus({});
  CanBus& listener = bus.attach();
  const CanFrame frames[] = {{0x123u << 18, true, true, 0, {}},
                             {0x123u << 18, true, false, 0, {}},
                             {0x123, false, true, 0, {}},
                             {0x123, false, false, 0, {}}};
  for (const CanFrame& frame : frames) {
    ASSERT_EQ(bus.attach().send(frame), SendResult::kSent);
  }
  bus.advance(1'000'000);
  const auto arrived = drain(listener);
  ASSERT_EQ(arrived.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(arrived[i].frame, frames[3 - i]);
}

TEST(VirtualBus, AFullQueueTakesNoFrameAndCountsIt) {
  VirtualBus bus({});
  CanBus& a = bus.attach({.transmit_frames = 2});
  CanBus& b = bus.attach({.receive_frames = 1});
  EXPECT_EQ(a.send(frame_of(1)), SendResult::kSent);
  EXPECT_EQ(a.send(frame_of(2)), SendResult::kSent);
  EXPECT_EQ(a.send(frame_of(3)), SendResult::kQueueFull);
  bus.advance(1'000'000);
  EXPECT_EQ(a.send(frame_of(4)), SendResult::kSent) << "what has left makes room";
  EXPECT_EQ(a.status().send_failures, 1u);
  EXPECT_EQ(a.status().sent, 3u);
  EXPECT_EQ(identifiers(drain(b)), std::vector<std::uint32_t>{1});
  EXPECT_EQ(b.status().overruns, 1u);
}

TEST(VirtualBus, AnySpeedAndFdFramesTakeAsLongAsTheirBits) {
  const CanFrame frame{0x181, false, false, 8, {1, 2, 3, 4, 5, 6, 7, 8}};
  const auto arrival_ns = [&](const VirtualBus::Parameters& parameters) {
    VirtualBus bus(parameters);
    CanBus& a = bus.attach();
    CanBus& b = bus.attach();
    EXPECT_EQ(a.send(frame), SendResult::kSent);
    bus.advance(100'000'000);
    return drain(b).at(0).time_ns;
  };
  const std::int64_t bits = classic_frame_bits(frame).nominal;
  EXPECT_EQ(arrival_ns({.bitrate_bps = 125'000}), 8000 * bits);
  EXPECT_EQ(arrival_ns({.bitrate_bps = 800'000}), 1250 * bits);
  EXPECT_EQ(arrival_ns({.bitrate_bps = 0}), 0);
  const FrameBits fd = fd_frame_bits(frame.id, false, frame.data, true);
  EXPECT_EQ(arrival_ns({.bitrate_bps = 500'000, .data_bitrate_bps = 4'000'000}),
            2000 * fd.nominal + 250 * fd.data);
}

TEST(VirtualBus, WithoutABitRateAFrameIsThereBeforeSendReturns) {
  VirtualBus bus({.bitrate_bps = 0});
  CanBus& a = bus.attach();
  CanBus& b = bus.attach();
  bus.advance(42);
  EXPECT_EQ(a.send(frame_of(1, 10)), SendResult::kSent);
  EXPECT_EQ(a.send(frame_of(2, 20)), SendResult::kSent);
  const auto frames = drain(b);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].frame, frame_of(1, 10));
  EXPECT_EQ(frames[1].time_ns, 42);
}

// --- errors --------------------------------------------------------------------------------------

TEST(VirtualBus, ALoneSenderDoesNotGetThroughAndStopsAtErrorPassive) {
  VirtualBus bus({});
  CanBus& a = bus.attach();
  ASSERT_EQ(a.send(frame_of(0x100)), SendResult::kSent);
  bus.advance(20'000'000);
  EXPECT_EQ(bus.error_counters(0).transmit, 128u) << "8 for each of 16 attempts, then no more";
  EXPECT_TRUE(a.status().error_passive);
  EXPECT_FALSE(a.status().bus_off);
  EXPECT_EQ(bus.statistics().frames, 0u);
  CanBus& b = bus.attach();
  bus.advance(20'500'000);
  EXPECT_EQ(identifiers(drain(b)), std::vector<std::uint32_t>{0x100}) << "somebody acknowledges";
  EXPECT_EQ(bus.error_counters(0).transmit, 127u);
  EXPECT_FALSE(a.status().error_passive);
}

TEST(VirtualBus, AnUnacknowledgedFrameComesAgainAfterItsErrorFrame) {
  // frame up to the ACK slot | error flag 6, delimiter 8, intermission 3 | the frame again
  VirtualBus bus({});
  CanBus& a = bus.attach();
  ASSERT_EQ(a.send(frame_of(0x100)), SendResult::kSent);
  const std::int64_t failed_ns = length_ns(frame_of(0x100)) - 8 * kBit_ns;
  EXPECT_EQ(bus.next_event_ns(), length_ns(frame_of(0x100)));
  bus.advance(failed_ns);
  EXPECT_EQ(bus.error_counters(0).transmit, 8u);
  CanBus& b = bus.attach();
  bus.advance(1'000'000);
  EXPECT_EQ(drain(b).at(0).time_ns, failed_ns + 17 * kBit_ns + length_ns(frame_of(0x100)));
}

TEST(VirtualBus, DestroyedFramesAreRepeatedAndCountedByTheStandardsRules) {
  VirtualBus bus({.bit_error_rate = 1e-3, .seed = 5});
  CanBus& a = bus.attach({.transmit_frames = 1000});
  CanBus& b = bus.attach();
  for (std::uint32_t id = 0; id < 1000; ++id) {
    ASSERT_EQ(a.send(frame_of(id)), SendResult::kSent);
  }
  bus.advance(200'000'000);
  const auto frames = drain(b);
  ASSERT_EQ(frames.size(), 1000u) << "nothing is lost";
  for (std::uint32_t id = 0; id < 1000; ++id) ASSERT_EQ(frames[id].frame.id, id);
  // About 60 bits a frame, so one in 17 attempts fails.
  EXPECT_NEAR(static_cast<double>(bus.statistics().error_frames), 1000.0 / 16.0, 30.0);
  EXPECT_EQ(a.status().error_frames, bus.statistics().error_frames);
  EXPECT_LT(bus.error_counters(0).transmit, 128u);
  EXPECT_LT(bus.error_counters(1).receive, 20u);
}

TEST(VirtualBus, EqualSeedsGiveEqualErrors) {
  const auto arrivals = [](std::uint64_t seed) {
    VirtualBus bus({.bit_error_rate = 5e-3, .seed = seed});
    CanBus& a = bus.attach();
    CanBus& b = bus.attach();
    for (std::uint32_t id = 0; id < 50; ++id) EXPECT_EQ(a.send(frame_of(id)), SendResult::kSent);
    bus.advance(50'000'000);
    std::vector<std::int64_t> times;
    for (const ReceivedFrame& received : drain(b)) times.push_back(received.time_ns);
    return times;
  };
  EXPECT_EQ(arrivals(1), arrivals(1));
  EXPECT_NE(arrivals(1), arrivals(2));
}

TEST(VirtualBus, TooManyErrorsLeadToBusOffAndRecoveryTakes128TimesElevenRecessiveBits) {
  VirtualBus bus({.bit_error_rate = 0.2, .seed = 3});
  CanBus& a = bus.attach();
  CanBus& b = bus.attach();
  ASSERT_EQ(a.send(frame_of(0x100)), SendResult::kSent);
  while (!a.status().bus_off && bus.now_ns() < 100'000'000) bus.advance(bus.now_ns() + 1000);
  ASSERT_TRUE(a.status().bus_off);
  EXPECT_EQ(bus.statistics().error_frames, 32u) << "256 / 8";
  EXPECT_EQ(bus.error_counters(1).receive, 32u);
  EXPECT_EQ(a.send(frame_of(0x101)), SendResult::kDown);
  const std::int64_t asked_ns = bus.now_ns();
  bus.advance(asked_ns + 10'000'000);
  EXPECT_TRUE(a.status().bus_off) << "nobody asked for recovery";
  bus.recover(0);
  bus.advance(asked_ns + 10'000'000 + 128 * 11 * kBit_ns - 1);
  EXPECT_TRUE(a.status().bus_off);
  bus.advance(asked_ns + 10'000'000 + 128 * 11 * kBit_ns);
  EXPECT_FALSE(a.status().bus_off);
  EXPECT_EQ(bus.error_counters(0).transmit, 0u);
  EXPECT_TRUE(drain(b).empty()) << "what waited at bus-off is gone";
}

TEST(VirtualBus, RecoveryOnABusyBusCountsEachFramesEnd) {
  VirtualBus bus({});
  CanBus& a = bus.attach();
  CanBus& b = bus.attach({.transmit_frames = 100});
  CanBus& c = bus.attach();
  bus.set_bus_off(0, true);
  bus.recover(0);
  for (int i = 0; i < 20; ++i) ASSERT_EQ(b.send(frame_of(0x100)), SendResult::kSent);
  const std::int64_t busy_ns = length_ns(frame_of(0x100)) + 3 * kBit_ns;
  const std::int64_t back_ns = 20 * busy_ns + (128 - 20) * 11 * kBit_ns;
  bus.advance(back_ns - 1);
  EXPECT_TRUE(a.status().bus_off);
  bus.advance(back_ns);
  EXPECT_FALSE(a.status().bus_off);
  EXPECT_EQ(drain(c).size(), 20u);
  EXPECT_TRUE(drain(a).empty()) << "bus-off hears nothing";
}

TEST(VirtualBus, AnErrorPassiveSenderPausesForEightBits) {
  VirtualBus bus({});
  CanBus& a = bus.attach();
  ASSERT_EQ(a.send(frame_of(0x001)), SendResult::kSent);
  bus.advance(20'000'000);  // alone: error passive by now
  ASSERT_TRUE(a.status().error_passive);
  const std::uint64_t before = bus.statistics().error_frames;
  bus.advance(120'000'000);
  // The frame up to its ACK slot, error frame and intermission 17, pause 8.
  const double attempt_ns =
      static_cast<double>(length_ns(frame_of(0x001)) - 8 * kBit_ns + (17 + 8) * kBit_ns);
  EXPECT_NEAR(static_cast<double>(bus.statistics().error_frames - before), 100e6 / attempt_ns, 1.0);
}

TEST(VirtualBus, DownLosesWhatWaitsAndRefusesWhatComes) {
  VirtualBus bus({});
  CanBus& a = bus.attach();
  CanBus& b = bus.attach();
  ASSERT_EQ(a.send(frame_of(1)), SendResult::kSent);
  bus.advance(10'000);
  bus.set_up(false);
  EXPECT_FALSE(a.status().up);
  EXPECT_FALSE(b.status().up);
  EXPECT_EQ(a.send(frame_of(2)), SendResult::kDown);
  bus.set_up(true);
  bus.advance(1'000'000);
  EXPECT_TRUE(drain(b).empty());
}

TEST(VirtualBus, TheObserverSeesWhatWasSentWhenAndHowLong) {
  VirtualBus bus({});
  CanBus& a = bus.attach();
  CanBus& b = bus.attach();
  std::vector<VirtualBus::Transmission> seen;
  bus.set_observer([&](const VirtualBus::Transmission& t) { seen.push_back(t); });
  ASSERT_EQ(a.send(frame_of(0x300)), SendResult::kSent);
  bus.advance(7'000);
  ASSERT_EQ(b.send(frame_of(0x100)), SendResult::kSent);
  bus.advance(1'000'000);
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[1].frame, frame_of(0x100));
  EXPECT_EQ(seen[1].end, 1u);
  EXPECT_EQ(seen[1].queued_ns, 7'000);
  EXPECT_EQ(seen[1].start_ns, length_ns(frame_of(0x300)) + 3 * kBit_ns);
  EXPECT_EQ(seen[1].end_ns, seen[1].start_ns + length_ns(frame_of(0x100)));
  EXPECT_EQ(bus.statistics().busy_ns, seen[1].end_ns + 3 * kBit_ns);
}

}  // namespace
}  // namespace tenon::sim
