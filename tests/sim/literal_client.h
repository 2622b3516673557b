#pragma once
// A master for tests that speaks in literal bytes, so that no codec of Tenon's checks itself: a bus
// whose frames the test writes and reads by hand.

#include <cstdint>
#include <deque>
#include <initializer_list>
#include <string>
#include <vector>

#include "shared/ports/can_bus.h"

namespace tenon::sim {

/// The devices' end of a bus whose other end is the test itself.
class LiteralBus final : public CanBus {
 public:
  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override {
    from_devices.push_back(frame);
    return SendResult::kSent;
  }
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override {
    if (to_devices.empty()) return false;
    received = {to_devices.front(), 0};
    to_devices.pop_front();
    return true;
  }
  void flush() noexcept override { ++flushes; }
  void wait(std::int64_t /*at_most_ns*/) noexcept override {}
  [[nodiscard]] CanBusStatus status() const noexcept override { return {}; }

  std::deque<CanFrame> to_devices;
  std::vector<CanFrame> from_devices;
  int flushes = 0;
};

[[nodiscard]] inline CanFrame frame_of(std::uint32_t id, std::initializer_list<int> bytes) {
  CanFrame frame;
  frame.id = id;
  for (const int byte : bytes) frame.data[frame.length++] = static_cast<std::uint8_t>(byte);
  return frame;
}

/// "201#0F00": how candump writes it.
[[nodiscard]] inline std::string text_of(const CanFrame& frame) {
  static constexpr char kDigits[] = "0123456789ABCDEF";
  std::string text;
  for (int shift = 8; shift >= 0; shift -= 4) text += kDigits[frame.id >> shift & 15U];
  text += '#';
  for (std::size_t i = 0; i < frame.length; ++i) {
    text += kDigits[frame.data[i] >> 4U];
    text += kDigits[frame.data[i] & 15U];
  }
  return text;
}

[[nodiscard]] inline std::vector<std::string> texts_of(const std::vector<CanFrame>& frames) {
  std::vector<std::string> texts;
  for (const CanFrame& frame : frames) texts.push_back(text_of(frame));
  return texts;
}

[[nodiscard]] inline std::int16_t i16_at(const CanFrame& frame, std::size_t at) {
  return static_cast<std::int16_t>(frame.data[at] | frame.data[at + 1] << 8);
}

[[nodiscard]] inline std::int32_t i32_at(const CanFrame& frame, std::size_t at) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(frame.data[at]) |
                                   static_cast<std::uint32_t>(frame.data[at + 1]) << 8 |
                                   static_cast<std::uint32_t>(frame.data[at + 2]) << 16 |
                                   static_cast<std::uint32_t>(frame.data[at + 3]) << 24);
}

}  // namespace tenon::sim
