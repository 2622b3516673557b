#include "executor/sensing/frozen_watch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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
    : watches_(std::pow(chance_of_the_same_wrench(sensor), kFrozenSamples - 1) <= kChanceMost) {}

bool FrozenWatch::update(const Vector6& raw, std::uint16_t counter) {
  const bool same = same_ > 0 && raw == last_ && counter != last_counter_;
  same_ = same ? same_ + 1 : 1;
  last_ = raw;
  last_counter_ = counter;
  return watches_ && same_ >= kFrozenSamples;
}

}  // namespace tenon::executor
