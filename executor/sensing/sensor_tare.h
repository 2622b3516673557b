#pragma once
// The mean of a resting sensor, refused where the sensor was not at rest. Real-time, one thread.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "executor/states/ending.h"
#include "shared/cell/robot.h"
#include "shared/math/pose.h"

namespace tenon::executor {

class SensorTare {
 public:
  struct Parameters {
    int samples = 200;
    double force_deviation_max_N = 0.5;  ///< standard deviation on any axis
    double torque_deviation_max_Nm = 0.05;
  };

  /// For a sensor: it may be three times as noisy as its data sheet says, and where the sheet is
  /// silent, or finer than a count, a count or a little is allowed.
  [[nodiscard]] static Parameters parameters_for(const ForceTorqueSensor& sensor, int samples) {
    constexpr double kForce_N = 0.05;
    constexpr double kTorque_Nm = 0.005;
    constexpr double kNoiseFactor = 3.0;
    return {
        samples,
        std::max({kForce_N, kNoiseFactor * sensor.force_noise_N, sensor.force_per_count_N}),
        std::max({kTorque_Nm, kNoiseFactor * sensor.torque_noise_Nm, sensor.torque_per_count_Nm})};
  }

  enum class Status : std::uint8_t {
    kGathering = 0,
    kDone = 1,
    kUnsteady = 2,  ///< a standard deviation above its bound; see worst_axis()
  };

  explicit SensorTare(const Parameters& parameters) : parameters_(parameters) {}

  /// One fresh sample, N and Nm. After the last one the answer stands.
  Status add(const Vector6& sample) {
    if (status_ != Status::kGathering) return status_;
    ++count_;
    // Welford's recurrence: no loss of digits where the mean is large against the deviation.
    const Vector6 before = sample - mean_;
    mean_ += before / count_;
    squares_ += before.cwiseProduct(sample - mean_);
    // Likewise, against the sample's number.
    products_ += 0.5 * (count_ - 1) * before;
    if (count_ >= parameters_.samples) decide();
    return status_;
  }

  /// Forgets all samples.
  void start_again() { *this = SensorTare(parameters_); }

  [[nodiscard]] Status status() const { return status_; }
  [[nodiscard]] const Vector6& mean() const { return mean_; }
  /// What is left of an axis' standard deviation once the line is taken off that fits its samples
  /// best: noise, without a steady drift.
  [[nodiscard]] double deviation_beside_drift(int axis) const {
    if (count_ < 3) return 0.0;
    const double n = count_;
    const double spread = n * (n * n - 1.0) / 12.0;  // squares of the samples' numbers
    const double drift = products_[axis] * products_[axis] / spread;
    return std::sqrt(std::max(0.0, squares_[axis] - drift) / (n - 2.0));
  }
  /// Axis 0..5 whose standard deviation is largest against its bound.
  [[nodiscard]] int worst_axis() const { return worst_axis_; }
  [[nodiscard]] double deviation(int axis) const {
    return count_ > 1 ? std::sqrt(squares_[axis] / (count_ - 1)) : 0.0;
  }
  [[nodiscard]] double deviation_max(int axis) const {
    return axis < 3 ? parameters_.force_deviation_max_N : parameters_.torque_deviation_max_Nm;
  }

 private:
  void decide() {
    double worst = -1.0;
    for (int axis = 0; axis < 6; ++axis) {
      const double ratio = deviation(axis) / deviation_max(axis);
      if (ratio <= worst) continue;
      worst = ratio;
      worst_axis_ = axis;
    }
    status_ = worst <= 1.0 ? Status::kDone : Status::kUnsteady;
  }

  Parameters parameters_;
  Status status_ = Status::kGathering;
  int count_ = 0;
  int worst_axis_ = 0;
  Vector6 mean_ = Vector6::Zero();
  Vector6 squares_ = Vector6::Zero();
  Vector6 products_ = Vector6::Zero();
};

/// How a run ends whose sensor was kUnsteady.
[[nodiscard]] inline Ending unsteady(const SensorTare& tare) {
  const int axis = tare.worst_axis();
  return {.reason = EndReason::kTareUnsteady,
          .index = axis,
          .value = tare.deviation(axis),
          .bound = tare.deviation_max(axis)};
}

}  // namespace tenon::executor
