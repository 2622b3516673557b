#pragma once
// Whether a wrench that should stay as it is moves away: the mean of the newest samples against
// that of the first, both as many. What noise makes of the difference is known. Real-time, one
// thread.

#include <cmath>
#include <optional>

#include "shared/math/pose.h"

namespace tenon::executor {

class DriftWatch {
 public:
  /// Of the deviation that the difference of two means may have: 2e-9 at the noise that is allowed.
  static constexpr double kDeviations = 6.0;

  struct Parameters {
    int samples = 100;                   ///< that make a mean
    double force_deviation_N = 0.3;      ///< that a sample may have on any axis
    double torque_deviation_Nm = 0.015;  ///< likewise
    double force_per_count_N = 0.0;      ///< what rounding may shift a mean by
    double torque_per_count_Nm = 0.0;
  };
  struct Drift {
    int axis = 0;
    double moved = 0.0;  ///< N or Nm
    double bound = 0.0;
  };

  explicit DriftWatch(const Parameters& parameters) : parameters_(parameters) {}

  /// What came before counts no more.
  void restart() {
    first_.reset();
    sum_.setZero();
    count_ = 0;
  }

  /// One fresh sample. @return an axis whose mean has moved, once every `samples` samples
  [[nodiscard]] std::optional<Drift> add(const Vector6& sample) {
    sum_ += sample;
    if (++count_ < parameters_.samples) return std::nullopt;
    const Vector6 mean = sum_ / count_;
    sum_.setZero();
    count_ = 0;
    if (!first_) {
      first_ = mean;
      return std::nullopt;
    }
    std::optional<Drift> worst;
    for (int axis = 0; axis < 6; ++axis) {
      const double moved = mean[axis] - (*first_)[axis];
      const double bound = bound_of(axis);
      if (std::abs(moved) <= bound) continue;
      if (worst && std::abs(moved) / bound <= std::abs(worst->moved) / worst->bound) continue;
      worst = Drift{axis, moved, bound};
    }
    return worst;
  }

  /// The first mean was zero as far as noise can tell: nothing touched.
  [[nodiscard]] bool began_at_zero() const {
    for (int axis = 0; axis < 6; ++axis) {
      if (!first_ || std::abs((*first_)[axis]) > bound_of(axis)) return false;
    }
    return true;
  }
  [[nodiscard]] double bound_of(int axis) const {
    const double deviation =
        axis < 3 ? parameters_.force_deviation_N : parameters_.torque_deviation_Nm;
    const double per_count =
        axis < 3 ? parameters_.force_per_count_N : parameters_.torque_per_count_Nm;
    return kDeviations * deviation * std::sqrt(2.0 / parameters_.samples) + per_count;
  }

 private:
  Parameters parameters_;
  std::optional<Vector6> first_;
  Vector6 sum_ = Vector6::Zero();
  int count_ = 0;
};

}  // namespace tenon::executor
