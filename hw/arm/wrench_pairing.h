#pragma once
// Joins the two frames of a force/torque sample by their sample counters, so that a wrench is never
// made of halves of two samples. Counts are raw. Real-time, no clock; one thread; owns its memory.
//
//   181h: | 0-1 fx | 2-3 fy | 4-5 fz | 6-7 counter |     i16 and u16, little-endian
//   182h: | 0-1 tx | 2-3 ty | 4-5 tz | 6-7 counter |

#include <array>
#include <cstdint>
#include <optional>

#include "shared/ports/can_bus.h"

namespace tenon::hw {

class WrenchPairing {
 public:
  enum class Half : std::uint8_t { kForce = 0, kTorque = 1 };
  struct Sample {
    std::array<std::int16_t, 6> counts{};  ///< fx fy fz tx ty tz
    std::uint16_t counter = 0;
    bool repeated = false;  ///< the counter is that of the sample before
  };

  /// Takes in an 8-byte frame; the whole sample once both halves are there.
  [[nodiscard]] std::optional<Sample> process(Half half, const CanFrame& frame);
  /// Halves dropped because their other half never came, or came from another sample.
  [[nodiscard]] std::uint64_t torn() const { return torn_; }
  void reset() { *this = WrenchPairing{}; }

 private:
  struct Pending {
    bool waiting = false;
    std::array<std::int16_t, 3> counts{};
    std::uint16_t counter = 0;
  };
  std::array<Pending, 2> halves_{};
  std::optional<std::uint16_t> last_counter_;
  std::uint64_t torn_ = 0;
};

}  // namespace tenon::hw
