#pragma once
// Whether a sensor still measures. One that is dead behind a counter that runs on repeats its last
// wrench to the count; a sensor that is alive cannot, because of its noise. Real-time, one thread.

#include <cstdint>

#include "executor/faults/fault_bounds.h"
#include "shared/cell/robot.h"
#include "shared/math/pose.h"

namespace tenon::executor {

class FrozenWatch {
 public:
  /// That a sensor which is alive is named all the same, each sample: once in 60 years at 500 Hz.
  static constexpr double kChanceMost = 1e-12;
  /// A sensor may be so much quieter than its data sheet says, or filtered.
  static constexpr double kQuieter = 10.0;

  explicit FrozenWatch(const ForceTorqueSensor& sensor);

  /// One new sample, N and Nm, as it was read. True: it and the kFrozenSamples - 1 before it are
  /// the same in all six axes, and their counter ran.
  [[nodiscard]] bool update(const Vector6& raw, std::uint16_t counter);

  /// False: the noise is too small against a count for equal samples to tell anything.
  [[nodiscard]] bool watches() const { return watches_; }

 private:
  bool watches_;
  Vector6 last_ = Vector6::Zero();
  std::uint16_t last_counter_ = 0;
  int same_ = 0;  ///< samples in a row that are equal, the first included
};

}  // namespace tenon::executor
