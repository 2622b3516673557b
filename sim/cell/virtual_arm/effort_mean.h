#pragma once
// What drives report of their efforts: the mean of the last cycle, as a current loop of some kHz
// with its filter does, and what their current sensors are off by, anew in every cycle. Setpoints
// come once a cycle, and so does what the servo makes of each: one instant of a cycle says little.
// Noise is the same for the same seed, on every platform, of each drive by a stream of its own.
// Private to sim.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shared/base/random.h"

namespace tenon::sim {

class EffortMean {
 public:
  /// @param steps of physics in a cycle, at least 1
  /// @param noise_permille of the rated effort, standard deviation; 0: none
  EffortMean(std::size_t joints, std::size_t steps, double noise_permille, std::uint64_t seed)
      : steps_(steps),
        last_(joints * steps, 0.0),
        sums_(joints, 0.0),
        noise_permille_(noise_permille),
        off_permille_(joints, 0.0) {
    const std::uint64_t all = stream_seed(seed, "effort_noise");
    for (std::size_t i = 0; i < joints; ++i) noise_.emplace_back(stream_seed(all, i));
  }

  /// Once a step of physics, a joint each; then next().
  void add(std::size_t joint, double effort) {
    double& oldest = last_[joint * steps_ + at_];
    sums_[joint] += effort - oldest;
    oldest = effort;
  }
  void next() {
    at_ = (at_ + 1) % steps_;
    if (at_ != 0) return;
    for (std::size_t i = 0; i < noise_.size(); ++i) {
      off_permille_[i] = noise_permille_ * noise_[i].normal();
    }
  }
  /// N or Nm.
  [[nodiscard]] double of(std::size_t joint) const {
    return sums_[joint] / static_cast<double>(steps_);
  }
  /// By which the drive misreads that while it has power, in thousandths of its rated effort.
  [[nodiscard]] double off_permille(std::size_t joint) const { return off_permille_[joint]; }

 private:
  std::size_t steps_;
  std::vector<double> last_;
  std::vector<double> sums_;
  std::size_t at_ = 0;
  double noise_permille_;
  std::vector<Random> noise_;
  std::vector<double> off_permille_;
};

}  // namespace tenon::sim
