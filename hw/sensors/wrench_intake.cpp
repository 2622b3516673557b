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
  source_.reset();
  pairing_.reset();
  unwell_.reset();
  force_N_.reset();
  sample_.reset();
  saturated_.reset();
  halves_seen_ = 0;
  cycles_since_sample_ = 0;
}

WrenchSource::Taken WrenchIntake::take(const CanFrame& frame, std::int64_t time_ns) noexcept {
  force_N_.reset();
  sample_.reset();
  saturated_.reset();
  unwell_.reset();
  if (frame.bus != sensor_.bus()) return WrenchSource::Taken::kForeign;
  WrenchHalf half;
  const WrenchSource::Taken taken = source_.take(frame, time_ns, half);
  if (taken != WrenchSource::Taken::kHalf) return taken;
  if (half.status != 0) unwell_ = half.status;
  force_N_ = source_.force_N(half);
  // Whatever the other half says: what is at its end is no force.
  if (force_N_) look_for_ends({force_N_->data(), 3}, half.raw);
  halves_seen_ = static_cast<std::uint8_t>(halves_seen_ | (1u << half.place));
  const auto paired = pairing_.process(half);
  if (paired && !paired->repeated) take_sample(*paired);
  return taken;
}

void WrenchIntake::take_sample(const WrenchPairing::Sample& paired) noexcept {
  sample_ = Sample{source_.wrench(paired.counts), paired.counter};
  cycles_since_sample_ = 0;
  look_for_ends({sample_->wrench.data(), 6}, paired.counts);
}

void WrenchIntake::look_for_ends(std::span<const double> readings,
                                 std::span<const std::int16_t> raw) noexcept {
  for (std::size_t axis = 0; axis < readings.size(); ++axis) {
    const double range = axis < 3 ? sensor_.force_range_N : sensor_.torque_range_Nm;
    const double reading = readings[axis];
    if (range <= 0.0 || std::abs(reading) < range) continue;
    saturated_ = Saturated{static_cast<std::uint8_t>(axis), raw[axis], reading};
    return;
  }
  // A range of 0 is not given; the 16 bits still end somewhere.
  for (std::size_t place = 0; place < raw.size(); ++place) {
    if (std::abs(int{raw[place]}) < kRawEnd) continue;
    saturated_ = Saturated{static_cast<std::uint8_t>(place), raw[place], std::nullopt};
    return;
  }
}

}  // namespace tenon::hw
