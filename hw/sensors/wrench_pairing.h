#pragma once
// Joins the two halves of a force/torque sample by their sample counters, so that a wrench is never
// made of halves of two samples. Real-time, no clock; one thread; owns its memory.

#include <array>
#include <cstdint>
#include <optional>

#include "shared/ports/wrench_source.h"

namespace tenon::hw {

class WrenchPairing {
 public:
  struct Sample {
    std::array<std::int16_t, 6> counts{};  ///< raw values of both halves
    std::uint16_t counter = 0;
    bool repeated = false;  ///< the counter is that of the sample before
  };

  /// The whole sample once both halves are there.
  [[nodiscard]] std::optional<Sample> process(const WrenchHalf& half);
  /// Halves dropped because their other half never came, or came from another sample.
  [[nodiscard]] std::uint64_t torn() const { return torn_; }
  void reset() { *this = WrenchPairing{}; }

 private:
  struct Pending {
    bool waiting = false;
    WrenchHalf half;
  };
  std::array<Pending, 2> halves_{};
  std::optional<std::uint16_t> last_counter_;
  std::uint64_t torn_ = 0;
};

}  // namespace tenon::hw
