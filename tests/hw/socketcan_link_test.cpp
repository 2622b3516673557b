// What is read from the kernel's answer about a CAN interface, and what is refused because of it.
// The bytes are written out by hand; what only a real bus can bring about (bus-off) is among them.
// tests/socketcan holds the same against a real kernel.

#include "hw/can/socketcan_link.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "shared/base/error.h"
#include "tests/support/refusal.h"

namespace tenon::hw {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes u32(std::uint32_t value) {
  return {std::uint8_t(value), std::uint8_t(value >> 8), std::uint8_t(value >> 16),
          std::uint8_t(value >> 24)};
}

Bytes text(const std::string& value) {
  Bytes bytes(value.begin(), value.end());
  bytes.push_back(0);
  return bytes;
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

// Bytes 0-1 length without padding, 2-3 type, then the payload, padded to 4.
Bytes attribute(std::uint8_t type, const Bytes& payload) {
  Bytes bytes = {std::uint8_t(payload.size() + 4), 0, type, 0};
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  bytes.resize((bytes.size() + 3) / 4 * 4);
  return bytes;
}

// Bytes 0-3 length, 4-5 type (16: a link), 6-15 flags, sequence, port; then 16 family, 18-19 kind
// of hardware (280: CAN), 20-23 index, 24-27 flags (1: up, 64: running), 28-31 change; attributes.
Bytes message(std::uint8_t flags, const Bytes& attributes) {
  return joined({{std::uint8_t(32 + attributes.size()), 0, 0, 0, 16, 0, 0, 0},
                 {0, 0, 0, 0, 0, 0, 0, 0},
                 {0, 0, 24, 1, 7, 0, 0, 0, flags, 0, 0, 0, 0, 0, 0, 0},
                 attributes});
}

/// A controller at 500 kbit/s with a queue of 10. 13: queue length, 6: discipline, 18: link info,
/// in it 1: kind, 2: data, in it 1: bit timing (the rate and seven more), 4: state, 5: mode (mask,
/// flags).
Bytes controller(std::uint8_t flags, std::uint32_t state, std::uint32_t mode) {
  Bytes timing = u32(500'000);
  timing.resize(32);
  const Bytes data = joined({attribute(1, timing), attribute(4, u32(state)),
                             attribute(5, joined({u32(0xFF), u32(mode)}))});
  return message(
      flags,
      joined({attribute(13, u32(10)), attribute(6, text("pfifo_fast")),
              attribute(18, joined({attribute(1, {'c', 'a', 'n', 0}), attribute(2, data)}))}));
}

Bytes virtual_interface() {
  return message(65, joined({attribute(13, u32(1000)), attribute(6, text("noqueue")),
                             attribute(18, attribute(1, text("vcan")))}));
}

std::string link_refusal(const Bytes& bytes, std::uint32_t bitrate_bps,
                         std::uint32_t burst_frames) {
  const auto link = parse_link(bytes);
  if (!link) return "nothing was read";
  return tests::refusal([&] { check_link(*link, "can0", bitrate_bps, burst_frames); });
}

TEST(SocketcanLink, AControllersAnswerIsRead) {
  const auto link = parse_link(controller(65, 1, 0));
  ASSERT_TRUE(link);
  EXPECT_EQ(link->index, 7);
  EXPECT_TRUE(link->is_can);
  EXPECT_TRUE(link->up);
  EXPECT_EQ(link->transmit_queue_frames, 10U);
  EXPECT_EQ(link->bitrate_bps, 500'000U);
  EXPECT_EQ(link->state, ControllerState::kErrorWarning);
  EXPECT_FALSE(link->listen_only);
  EXPECT_TRUE(parse_link(controller(65, 0, 2))->listen_only);
  EXPECT_FALSE(parse_link(controller(0, 4, 0))->up);
}

TEST(SocketcanLink, AVirtualInterfaceHasNeitherBitrateNorStateNorQueue) {
  const auto link = parse_link(virtual_interface());
  ASSERT_TRUE(link);
  EXPECT_TRUE(link->is_can);
  EXPECT_FALSE(link->transmit_queue_frames);
  EXPECT_FALSE(link->bitrate_bps);
  EXPECT_FALSE(link->state);
}

TEST(SocketcanLink, AnAnswerThatWasCutIsNoneOrHasLessInIt) {
  const Bytes whole = controller(65, 0, 0);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(parse_link(cut)) << "its header says more: " << size;
    if (size < 32) continue;
    cut[0] = static_cast<std::uint8_t>(size);
    const auto link = parse_link(cut);
    ASSERT_TRUE(link);
    EXPECT_FALSE(link->listen_only);
  }
  Bytes other = whole;
  other[4] = 17;
  EXPECT_FALSE(parse_link(other));
}

TEST(SocketcanLink, AnAttributeWithABadLengthEndsTheReading) {
  for (const int length : {0, 3, 200}) {
    Bytes bytes = controller(65, 0, 0);
    bytes[32] = static_cast<std::uint8_t>(length);
    const auto link = parse_link(bytes);
    ASSERT_TRUE(link);
    EXPECT_FALSE(link->transmit_queue_frames);
    EXPECT_FALSE(link->state);
  }
}

TEST(SocketcanLink, WhatCannotServeIsRefusedInOneLineThatSaysWhatToDo) {
  EXPECT_EQ(link_refusal(controller(65, 0, 0), 500'000, 10), "accepted");
  EXPECT_EQ(link_refusal(controller(65, 1, 0), 500'000, 1), "accepted") << "a warning is no reason";
  EXPECT_EQ(link_refusal(controller(0, 4, 0), 500'000, 1),
            "CAN bus socketcan:can0: the interface is down; "
            "'ip link set can0 up type can bitrate 500000'");
  EXPECT_EQ(
      link_refusal(controller(65, 3, 0), 500'000, 1),
      "CAN bus socketcan:can0: the controller is bus-off; check wiring, termination and every "
      "node's bit rate, then 'ip link set can0 down', then "
      "'ip link set can0 up type can bitrate 500000'");
  EXPECT_EQ(link_refusal(controller(65, 0, 0), 1'000'000, 1),
            "CAN bus socketcan:can0: runs at 500000 bit/s, wanted are 1000000 (robot file, or "
            "--bitrate); "
            "'ip link set can0 down', then 'ip link set can0 up type can bitrate 1000000'");
  EXPECT_NE(link_refusal(controller(65, 0, 2), 500'000, 1).find("only listens"), std::string::npos);
  EXPECT_EQ(link_refusal(controller(65, 0, 0), 500'000, 11),
            "CAN bus socketcan:can0: the transmit queue holds 10 frames, a cycle sends 11 at once; "
            "'ip link set can0 txqueuelen 100'");
  EXPECT_EQ(link_refusal(virtual_interface(), 1'000'000, 11), "accepted");
}

TEST(SocketcanLink, ABitrateMayDifferByWhatAClockCannotDivideInto) {
  EXPECT_EQ(link_refusal(controller(65, 0, 0), 502'500, 1), "accepted");
  EXPECT_NE(link_refusal(controller(65, 0, 0), 502'600, 1), "accepted");
}

TEST(SocketcanLink, TheKernelToldOfItsLoopback) {
  EXPECT_FALSE(read_link("lo").is_can);
  EXPECT_THROW((void)read_link("none0"), InputError);
  EXPECT_THROW((void)read_link(""), InputError);
  EXPECT_THROW((void)read_link("a-name-that-is-too-long"), InputError);
}

}  // namespace
}  // namespace tenon::hw
