#pragma once
// Watches the heartbeats of a few nodes. No I/O, no clock: frames and time are arguments.
// Real-time; one thread; owns its memory.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hw/canopen/heartbeat.h"

namespace tenon::hw::canopen {

class HeartbeatWatch {
 public:
  static constexpr std::size_t kMaxNodes = 16;
  static constexpr std::uint8_t kNotSeen = 0xFF;  ///< no state has this value

  /// Adds a node; at most kMaxNodes.
  void add(std::uint8_t node);
  /// Forgets every state and counts all silence from now.
  void restart(std::int64_t now_ns);
  /// False: not a node of the watch.
  bool process(const Heartbeat& heartbeat, std::int64_t now_ns);

  /// The state that the node last reported since restart(), kNotSeen where it was silent.
  [[nodiscard]] std::uint8_t state(std::uint8_t node) const;
  /// The first node that has been silent for longer than this.
  [[nodiscard]] std::optional<std::uint8_t> silent(std::int64_t now_ns,
                                                   std::int64_t timeout_ns) const;

 private:
  struct Entry {
    std::uint8_t node = 0;
    std::uint8_t state = kNotSeen;
    std::int64_t last_ns = 0;
  };
  std::array<Entry, kMaxNodes> entries_{};
  std::size_t count_ = 0;
};

}  // namespace tenon::hw::canopen
