#include "hw/arm/wrench_pairing.h"

#include <cassert>
#include <span>

#include "shared/base/bytes.h"

namespace tenon::hw {

std::optional<WrenchPairing::Sample> WrenchPairing::process(Half half, const CanFrame& frame) {
  assert(frame.length == 8);
  const auto mine = static_cast<std::size_t>(half);
  Pending& current = halves_[mine];
  Pending& other = halves_[1 - mine];
  if (current.waiting) {
    ++torn_;
  }
  const std::span<const std::uint8_t> bytes(frame.data);
  for (std::size_t i = 0; i < 3; ++i) {
    current.counts[i] = load_le<std::int16_t>(bytes.subspan(2 * i));
  }
  current.counter = load_le<std::uint16_t>(bytes.subspan(6));
  current.waiting = true;
  if (!other.waiting) {
    return std::nullopt;
  }
  if (other.counter != current.counter) {
    // Keep what is newer: its other half may still come.
    const auto ahead =
        static_cast<std::int16_t>(static_cast<std::uint16_t>(current.counter - other.counter));
    (ahead > 0 ? other : current).waiting = false;
    ++torn_;
    return std::nullopt;
  }
  Sample sample;
  for (std::size_t i = 0; i < 3; ++i) {
    sample.counts[i] = halves_[0].counts[i];
    sample.counts[3 + i] = halves_[1].counts[i];
  }
  sample.counter = current.counter;
  sample.repeated = last_counter_ == current.counter;
  last_counter_ = current.counter;
  current.waiting = other.waiting = false;
  return sample;
}

}  // namespace tenon::hw
