#pragma once
// Whether the sensor's zero is still where the tare has found it, seen on a tool that rests and
// holds no contact. Its setpoint is its pose, so that it yields to whatever pushes: what a body
// that it brushes pushes with falls off within D / k_e, and a zero that has moved stays. Real-time,
// one thread.

#include <cmath>
#include <cstdint>

#include "shared/math/pose.h"

namespace tenon::executor {

class ZeroWatch {
 public:
  struct Parameters {
    int samples = 100;                        ///< that make a mean
    std::uint8_t axes = 0x3F;                 ///< on which the tool yields
    Vector6 bound = Vector6::Constant(0.75);  ///< N and Nm, of a mean
  };
  enum class Status : std::uint8_t {
    kLooking = 0,
    kZero = 1,   ///< a mean within all bounds
    kMoved = 2,  ///< two means in a row beyond a bound, the second hardly less; see axis()
  };
  /// What is left of a push from one mean to the next, at most: less is one that falls off.
  static constexpr double kStays = 0.75;

  explicit ZeroWatch(const Parameters& parameters) : parameters_(parameters) {}

  /// One fresh sample. Once it has an answer, that stands.
  Status add(const Vector6& sample) {
    if (status_ != Status::kLooking) return status_;
    sum_ += sample;
    if (++count_ < parameters_.samples) return status_;
    const Vector6 mean = sum_ / count_;
    sum_.setZero();
    count_ = 0;
    status_ = Status::kZero;
    double worst = 1.0;
    for (int axis = 0; axis < 6; ++axis) {
      const double ratio = std::abs(mean[axis]) / parameters_.bound[axis];
      if ((parameters_.axes >> axis & 1U) == 0 || ratio <= worst) continue;
      worst = ratio;
      axis_ = axis;
      const bool stays = mean[axis] * before_[axis] > 0.0 &&
                         std::abs(mean[axis]) > kStays * std::abs(before_[axis]);
      status_ = stays ? Status::kMoved : Status::kLooking;
    }
    before_ = mean;
    return status_;
  }

  [[nodiscard]] Status status() const { return status_; }
  [[nodiscard]] int axis() const { return axis_; }
  /// Of that axis, the last mean and its bound.
  [[nodiscard]] double mean() const { return before_[axis_]; }
  [[nodiscard]] double bound() const { return parameters_.bound[axis_]; }
  [[nodiscard]] const Vector6& bounds() const { return parameters_.bound; }

 private:
  Parameters parameters_;
  Status status_ = Status::kLooking;
  Vector6 sum_ = Vector6::Zero();
  int count_ = 0;
  Vector6 before_ = Vector6::Zero();
  int axis_ = 0;
};

}  // namespace tenon::executor
