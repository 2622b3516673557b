#include "sim/cell/devices/wrench_sampler.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tenon::sim {
namespace {

constexpr double kCountMax = 32767.0;

}  // namespace

WrenchSampler::WrenchSampler(const ForceTorqueSensor& sensor, std::uint64_t seed,
                             const SensorImperfections& imperfections)
    : sensor_(sensor),
      imperfections_(imperfections),
      noise_(stream_seed(seed, "sensor_noise")),
      drift_(stream_seed(seed, "sensor_drift")),
      bias_(imperfections.bias) {}

void WrenchSampler::power_on(std::int64_t now_ns) {
  now_ns_ = drifted_ns_ = now_ns;
  tare_ = Vector6::Zero();
}

void WrenchSampler::advance(std::int64_t now_ns) {
  now_ns_ = now_ns;
  faults_.advance(now_ns);
}

void WrenchSampler::drift() {
  const double sqrt_s = std::sqrt(std::max(0.0, static_cast<double>(now_ns_ - drifted_ns_) * 1e-9));
  drifted_ns_ = now_ns_;
  if (imperfections_.force_drift_N_sqrts > 0.0) {
    for (int i = 0; i < 3; ++i)
      bias_[i] += imperfections_.force_drift_N_sqrts * sqrt_s * drift_.normal();
  }
  if (imperfections_.torque_drift_Nm_sqrts > 0.0) {
    for (int i = 3; i < 6; ++i)
      bias_[i] += imperfections_.torque_drift_Nm_sqrts * sqrt_s * drift_.normal();
  }
}

void WrenchSampler::measured(const Vector6& wrench, std::int64_t step_ns) {
  // Exact where the wrench is constant over the step.
  const double part =
      imperfections_.filter_s > 0.0
          ? -std::expm1(-1e-9 * static_cast<double>(step_ns) / imperfections_.filter_s)
          : 1.0;
  filtered_ += part * (wrench - filtered_);
}

const WrenchSampler::Sample& WrenchSampler::sample() {
  drift();
  const bool saturated = faults_.strikes(FaultKind::kSaturatedForce);
  sample_.overrange = faults_.strikes(FaultKind::kOverrangeForce);
  if (faults_.strikes(FaultKind::kFrozenForce)) return sample_;
  sample_.saturated = 0;
  sample_.forced = saturated;
  for (int axis = 0; axis < 6; ++axis) sample_axis(axis, saturated);
  return sample_;
}

void WrenchSampler::sample_axis(int axis, bool saturated) {
  const bool force = axis < 3;
  const double range = force ? sensor_.force_range_N : sensor_.torque_range_Nm;
  const double sigma = force ? sensor_.force_noise_N : sensor_.torque_noise_Nm;
  const double per_count = force ? sensor_.force_per_count_N : sensor_.torque_per_count_Nm;
  const double value = reading(axis) + sigma * noise_.normal() + (axis == 0 ? forged_N() : 0.0);
  if (saturated || !(std::abs(value) < range)) {
    sample_.saturated = static_cast<std::uint8_t>(sample_.saturated | 1U << axis);
  }
  const double limited = saturated ? range : std::clamp(value, -range, range);
  sample_.wrench[axis] = limited;
  sample_.counts[static_cast<std::size_t>(axis)] = static_cast<std::int16_t>(
      std::llround(std::clamp(limited / per_count, -kCountMax, kCountMax)));
}

double WrenchSampler::reading(int axis) const {
  const bool mixed = faults_.find(FaultKind::kWrongMatrix) != nullptr;
  const int group = 3 * (axis / 3);
  const int from = mixed ? group + (axis + 1) % 3 : axis;
  const Fault* units = faults_.find(FaultKind::kWrongUnits);
  const double factor = units == nullptr ? 1.0 : units->value;
  return factor * (filtered_[from] + bias_[from] - tare_[from]);
}

double WrenchSampler::forged_N() const {
  const Fault* forged = faults_.find(FaultKind::kForgedForce);
  const Fault* drifting = faults_.find(FaultKind::kDriftingForce);
  double force_N = forged == nullptr ? 0.0 : forged->value;
  if (drifting != nullptr) {
    force_N += drifting->value * 1e-9 * static_cast<double>(now_ns_ - drifting_since_ns_);
  }
  return force_N;
}

void WrenchSampler::tare(bool on) {
  tare_ = Vector6::Zero();
  if (!on) return;
  drift();
  tare_ = filtered_ + bias_;
}

void WrenchSampler::inject(const Fault& fault) {
  if (fault.kind == FaultKind::kDriftingForce) drifting_since_ns_ = now_ns_;
  faults_.begin(fault, now_ns_);
}

}  // namespace tenon::sim
