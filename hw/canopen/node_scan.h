#pragma once
// Who is on a bus: every node is asked for its device type (1000h), and all are heard out, however
// long each takes. Two answers to one request are two devices with one number. Frames and time are
// arguments; no I/O but the bus, no clock. One thread.

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "shared/ports/can_bus.h"

namespace tenon::hw::canopen {

class NodeScan {
 public:
  static constexpr std::int64_t kPause_ns = 2'000'000;  ///< so that no transmit queue overflows
  static constexpr std::int64_t kHearOut_ns = 1'000'000'000;  ///< after the last request
  static constexpr unsigned kNodes = 127;

  struct Found {
    unsigned answers = 0;
    std::optional<std::uint32_t> device_type;  ///< unset: it refused to say
  };

  /// Asks whom it is time to ask. Call it about every millisecond.
  void update(std::int64_t now_ns, CanBus& bus);
  void process(const CanFrame& frame);
  /// All have been asked and heard out.
  [[nodiscard]] bool done(std::int64_t now_ns) const;

  /// @param node 1..127
  [[nodiscard]] const Found& found(std::uint8_t node) const { return found_[node]; }
  /// Nodes that answered.
  [[nodiscard]] int count() const;
  /// Whether a number is that of several devices.
  [[nodiscard]] bool doubled() const;

 private:
  std::array<Found, kNodes + 1> found_{};
  unsigned asked_ = 0;
  std::int64_t next_ns_ = 0;
};

/// "node   3  CiA 402 drive, device type 0x00020192, vendor 0x000000FB". @param vendor unset: it
/// does not say
[[nodiscard]] std::string describe(std::uint8_t node, const NodeScan::Found& found,
                                   std::optional<std::uint32_t> vendor);

}  // namespace tenon::hw::canopen
