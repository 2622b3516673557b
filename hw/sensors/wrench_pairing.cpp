#include "hw/sensors/wrench_pairing.h"

#include <cassert>
#include <cstddef>

namespace tenon::hw {

std::optional<WrenchPairing::Sample> WrenchPairing::process(const WrenchHalf& half) {
  assert(half.place < halves_.size());
  Pending& current = halves_[half.place];
  Pending& other = halves_[1u - half.place];
  if (current.waiting) {
    ++torn_;
  }
  current = {true, half};
  if (!other.waiting) {
    return std::nullopt;
  }
  if (other.half.counter != half.counter) {
    // Keep what is newer: its other half may still come.
    const auto ahead =
        static_cast<std::int16_t>(static_cast<std::uint16_t>(half.counter - other.half.counter));
    (ahead > 0 ? other : current).waiting = false;
    ++torn_;
    return std::nullopt;
  }
  Sample sample;
  for (std::size_t i = 0; i < 3; ++i) {
    sample.counts[i] = halves_[0].half.raw[i];
    sample.counts[3 + i] = halves_[1].half.raw[i];
  }
  sample.counter = half.counter;
  sample.repeated = last_counter_ == half.counter;
  last_counter_ = half.counter;
  current.waiting = other.waiting = false;
  return sample;
}

}  // namespace tenon::hw
