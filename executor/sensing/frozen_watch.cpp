#include "executor/sensing/frozen_watch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "executor/sensing/repetition.h"

namespace tenon::executor {
namespace {

// Of normal noise no count is likelier than one at the density's peak, whatever came before.
double chance_of_a_count(double noise, double per_count) {
  if (!(noise > 0.0) || !(per_count > 0.0)) return 1.0;
  const double counts = noise / (FrozenWatch::kQuieter * per_count);
  return std::min(1.0, 1.0 / (counts * std::sqrt(2.0 * std::numbers::pi)));
}

double chance_of_the_same_wrench(const ForceTorqueSensor& sensor) {
  const double force = chance_of_a_count(sensor.force_noise_N, sensor.force_per_count_N);
  const double torque = chance_of_a_count(sensor.torque_noise_Nm, sensor.torque_per_count_Nm);
  return std::pow(force * torque, 3.0);
}

}  // namespace

FrozenWatch::FrozenWatch(const ForceTorqueSensor& sensor)
    : watches_(std::pow(chance_of_the_same_wrench(sensor), kFrozenSamples - 1) <=
               kRepetitionChanceMost) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    axes_[i].chance = i < 3 ? chance_of_a_count(sensor.force_noise_N, sensor.force_per_count_N)
                            : chance_of_a_count(sensor.torque_noise_Nm, sensor.torque_per_count_Nm);
  }
}

std::optional<FrozenWatch::Frozen> FrozenWatch::update(const Vector6& raw, std::uint16_t counter) {
  const bool runs = same_ > 0 && counter != last_counter_;
  std::optional<Frozen> frozen;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    const auto at = static_cast<Eigen::Index>(i);
    const bool repeats = runs && raw[at] == last_[at];
    axis.same = repeats ? axis.same + 1 : 1;
    if (runs && pairs_ < kLearnedPairs) axis.repeats += repeats ? 1 : 0;
    if (axis.samples_max == 0 || axis.same <= axis.samples_max || frozen) continue;
    frozen = Frozen{static_cast<int>(i), axis.same};
  }
  if (runs && pairs_ < kLearnedPairs && ++pairs_ == kLearnedPairs) {
    for (Axis& axis : axes_) learn(axis);
  }
  same_ = runs && raw == last_ ? same_ + 1 : 1;
  last_ = raw;
  last_counter_ = counter;
  if (watches_ && same_ >= kFrozenSamples) return Frozen{-1, same_};
  return frozen;
}

void FrozenWatch::learn(Axis& axis) const {
  if (!watches_) return;
  axis.samples_max =
      equal_samples_most(axis.repeats, kLearnedPairs, axis.chance, kFrozenAxisSamples - 1);
}

}  // namespace tenon::executor
