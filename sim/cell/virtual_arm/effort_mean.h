#pragma once
// What drives report of their efforts: the mean of the last cycle, as a current loop of some kHz
// with its filter does. Setpoints come once a cycle, and so does what the servo makes of each: one
// instant of a cycle says little. Private to sim.

#include <cstddef>
#include <vector>

namespace tenon::sim {

class EffortMean {
 public:
  /// @param steps of physics in a cycle, at least 1
  EffortMean(std::size_t joints, std::size_t steps)
      : steps_(steps), last_(joints * steps, 0.0), sums_(joints, 0.0) {}

  /// Once a step of physics, a joint each; then next().
  void add(std::size_t joint, double effort) {
    double& oldest = last_[joint * steps_ + at_];
    sums_[joint] += effort - oldest;
    oldest = effort;
  }
  void next() { at_ = (at_ + 1) % steps_; }
  /// N or Nm.
  [[nodiscard]] double of(std::size_t joint) const {
    return sums_[joint] / static_cast<double>(steps_);
  }

 private:
  std::size_t steps_;
  std::vector<double> last_;
  std::vector<double> sums_;
  std::size_t at_ = 0;
};

}  // namespace tenon::sim
