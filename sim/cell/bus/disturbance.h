#pragma once
// What may happen on a bus beyond its rules. A bus asks at each point; whoever disturbs it answers
// without knowing who sends or why. One thread; no answer may throw.

#include <cstddef>
#include <cstdint>

#include "shared/ports/can_bus.h"

namespace tenon::sim {

class Disturbance {
 public:
  /// Of a frame that has been sent.
  struct Fate {
    bool lost = false;          ///< nobody receives it, and the sender cannot tell
    bool repeated = false;      ///< everybody receives it twice
    std::int64_t delay_ns = 0;  ///< everybody receives it so much later
  };

  Disturbance() = default;
  Disturbance(const Disturbance&) = delete;
  Disturbance& operator=(const Disturbance&) = delete;
  virtual ~Disturbance() = default;

  /// What send() answers where the bus would take the frame.
  [[nodiscard]] virtual SendResult admit(const CanFrame& /*frame*/,
                                         std::int64_t /*now_ns*/) noexcept {
    return SendResult::kSent;
  }
  /// At the end of a frame, before anyone receives it; may alter the frame. `end` is the sender's.
  [[nodiscard]] virtual Fate fate(CanFrame& /*frame*/, std::size_t /*end*/,
                                  std::int64_t /*now_ns*/) noexcept {
    return {};
  }
  /// The interface is down for all.
  [[nodiscard]] virtual bool down(std::int64_t /*now_ns*/) const noexcept { return false; }
  /// The controller of this node has left the bus. Node 0 asks for an end of several nodes.
  [[nodiscard]] virtual bool bus_off(std::uint8_t /*node*/,
                                     std::int64_t /*now_ns*/) const noexcept {
    return false;
  }
};

}  // namespace tenon::sim
