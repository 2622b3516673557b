#pragma once
// Where the held part accelerates, guessed from what was commanded: the command reaches the arm
// through its response lag, and the sensor's sample is some cycles old. The lag's first cycle is
// dead time, since a target waits for the SYNC with which it is taken up; the rest, in which the
// drive moves there and the servo follows, is one of first order. Were all of it of first order, a
// compliant tool would answer to its own inertia. The one place to change for an arm with better
// knowledge of itself. Real-time, one thread.

#include <array>
#include <cstddef>

#include "shared/math/pose.h"

namespace tenon::executor {

class PayloadMotion {
 public:
  /// @param delay_cycles age of a measurement, 0..kDelayMax  @param lag_s from a setpoint to the
  /// motion, >= 0; less than a cycle has no dead time
  PayloadMotion(double cycle_s, double lag_s, int delay_cycles)
      : cycle_s_(cycle_s), delay_(static_cast<std::size_t>(delay_cycles)) {
    const bool waits = lag_s >= cycle_s;
    if (waits) ++delay_;
    blend_ = cycle_s / (cycle_s + lag_s - (waits ? cycle_s : 0.0));
  }

  static constexpr int kDelayMax = 15;

  /// Once a cycle: velocity commanded to the tool, m/s and rad/s, any fixed axes.
  void command(const Vector6& velocity) {
    commanded_[next_ % commanded_.size()] = velocity;
    const Vector6& arrived = commanded_[(next_ + commanded_.size() - delay_) % commanded_.size()];
    ++next_;
    const Vector6 change = blend_ * (arrived - velocity_);
    velocity_ += change;
    acceleration_ = change / cycle_s_;
  }

  /// m/s and rad/s, at the time of the sample that arrives next.
  [[nodiscard]] const Vector6& velocity() const { return velocity_; }
  /// m/s^2 and rad/s^2, at that time.
  [[nodiscard]] const Vector6& acceleration() const { return acceleration_; }

 private:
  double cycle_s_;
  double blend_ = 1.0;
  std::size_t delay_;
  std::size_t next_ = 0;
  std::array<Vector6, kDelayMax + 2> commanded_ = [] {
    std::array<Vector6, kDelayMax + 2> zero;
    zero.fill(Vector6::Zero());
    return zero;
  }();
  Vector6 velocity_ = Vector6::Zero();
  Vector6 acceleration_ = Vector6::Zero();
};

}  // namespace tenon::executor
