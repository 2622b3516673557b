#include "hw/sensors/wrench_intake.h"

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>

namespace tenon::hw {
namespace {

constexpr int kRawEnd = 32767;

}  // namespace

void WrenchIntake::reset() noexcept {
  pairing_.reset();
  force_N_.reset();
  sample_.reset();
  saturated_.reset();
  halves_seen_ = 0;
}

WrenchSource::Taken WrenchIntake::take(const CanFrame& frame) noexcept {
  force_N_.reset();
  sample_.reset();
  saturated_.reset();
  WrenchHalf half;
  const WrenchSource::Taken taken = source_.take(frame, half);
  if (taken != WrenchSource::Taken::kHalf) return taken;
  force_N_ = source_.force_N(half);
  halves_seen_ = static_cast<std::uint8_t>(halves_seen_ | (1u << half.place));
  const auto paired = pairing_.process(half);
  if (paired && !paired->repeated) take_sample(*paired);
  return taken;
}

void WrenchIntake::take_sample(const WrenchPairing::Sample& paired) noexcept {
  sample_ = Sample{source_.wrench(paired.counts), paired.counter};
  for (std::uint8_t axis = 0; axis < 6; ++axis) {
    const double range = axis < 3 ? sensor_.force_range_N : sensor_.torque_range_Nm;
    const double reading = sample_->wrench[axis];
    if (range <= 0.0 || std::abs(reading) < range) continue;
    saturated_ = Saturated{axis, paired.counts[axis], reading};
    return;
  }
  // A range of 0 is not given; the 16 bits still end somewhere.
  for (std::uint8_t place = 0; place < 6; ++place) {
    const std::int16_t raw = paired.counts[place];
    if (std::abs(int{raw}) < kRawEnd) continue;
    saturated_ = Saturated{place, raw, std::nullopt};
    return;
  }
}

}  // namespace tenon::hw
