// What a metered bus counts of frames whose lengths are known by heart.

#include "hw/can/metered_bus.h"

#include <gtest/gtest.h>

#include <utility>

#include "shared/ports/frame_bits.h"

namespace tenon::hw {
namespace {

class OneFrameBus : public CanBus {
 public:
  [[nodiscard]] SendResult send(const CanFrame& /*frame*/) noexcept override {
    if (result == SendResult::kSent) ++told.sent;
    return result;
  }
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override {
    received.frame = waiting;
    return std::exchange(there, false);
  }
  void flush() noexcept override {}
  void wait(std::int64_t /*at_most_ns*/) noexcept override {}
  [[nodiscard]] CanBusStatus status() const noexcept override { return told; }

  SendResult result = SendResult::kSent;
  CanFrame waiting;
  bool there = false;
  CanBusStatus told;
};

TEST(FrameBits, AreThoseOfTheStandard) {
  EXPECT_EQ(nominal_frame_bits(CanFrame{.id = 1, .length = 8}), 111U);
  EXPECT_EQ(worst_frame_bits(CanFrame{.id = 1, .length = 8}), 135U);
  // 67 bits with their intermission, and 64 of data; at most (54 + 64 - 1) / 4 stuffed.
  EXPECT_EQ(nominal_frame_bits(CanFrame{.id = 1, .extended = true, .length = 8}), 131U);
  EXPECT_EQ(worst_frame_bits(CanFrame{.id = 1, .extended = true, .length = 8}), 160U);
  EXPECT_EQ(nominal_frame_bits(CanFrame{.id = 1, .remote = true, .length = 8}), 47U);
}

TEST(MeteredBus, CountsWhatPassedAndShowsItAtTheNextWait) {
  OneFrameBus bus;
  MeteredBus metered(bus);
  EXPECT_EQ(metered.send({.id = 1, .length = 8}), SendResult::kSent);
  bus.result = SendResult::kQueueFull;
  EXPECT_EQ(metered.send({.id = 1, .length = 8}), SendResult::kQueueFull);
  bus.waiting.length = 0;
  bus.there = true;
  ReceivedFrame received;
  EXPECT_TRUE(metered.receive(received));
  EXPECT_FALSE(metered.receive(received));
  EXPECT_EQ(metered.traffic().nominal_bits, 0U);
  bus.told.send_failures = 1;
  bus.told.bus_off = true;
  metered.wait(0);
  const CanBusTraffic traffic = metered.traffic();
  EXPECT_EQ(traffic.nominal_bits, 111U + 47U);
  EXPECT_EQ(traffic.worst_bits, 135U + 55U);
  EXPECT_EQ(traffic.status.sent, 1U);
  EXPECT_EQ(traffic.status.send_failures, 1U);
  EXPECT_TRUE(traffic.status.bus_off);
}

}  // namespace
}  // namespace tenon::hw
