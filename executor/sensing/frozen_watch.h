#pragma once
// Whether a sensor still measures. One that is dead behind a counter that runs on repeats its last
// wrench to the count, or a single axis of it; what is alive cannot for long, because of its noise.
// Real-time, one thread.

#include <array>
#include <cstdint>
#include <optional>

#include "executor/faults/fault_bounds.h"
#include "shared/cell/robot.h"
#include "shared/math/pose.h"

namespace tenon::executor {

class FrozenWatch {
 public:
  struct Frozen {
    int axis = -1;    ///< 0..5; -1: all of them
    int samples = 0;  ///< in a row that were equal
  };

  /// A sensor may be so much quieter than its data sheet says, or filtered.
  static constexpr double kQuieter = 10.0;
  /// How often an axis repeats itself is seen in its first pairs of samples.
  static constexpr int kLearnedPairs = 200;

  explicit FrozenWatch(const ForceTorqueSensor& sensor);

  /// One new sample, N and Nm, as it was read, and its counter. @return what has not changed for so
  /// many samples, their counter running, that it cannot be alive
  [[nodiscard]] std::optional<Frozen> update(const Vector6& raw, std::uint16_t counter);

  /// False: the noise is too small against a count for equal samples to tell anything.
  [[nodiscard]] bool watches() const { return watches_; }

 private:
  struct Axis {
    double chance = 1.0;  ///< that a sample repeats the one before, by the data sheet
    int same = 0;         ///< samples in a row that are equal, the first included
    int repeats = 0;      ///< of the first pairs
    int samples_max = 0;  ///< that may be equal in a row; 0: not known, or too many
  };

  void learn(Axis& axis) const;

  bool watches_;
  std::array<Axis, 6> axes_{};
  int pairs_ = 0;  ///< learned from
  Vector6 last_ = Vector6::Zero();
  std::uint16_t last_counter_ = 0;
  int same_ = 0;  ///< samples in a row that are equal, the first included
};

}  // namespace tenon::executor
