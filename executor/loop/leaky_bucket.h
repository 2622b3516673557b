#pragma once
// Decides when bad cycles are too many: each fills the bucket, each good one lets a little out.
// Real-time, one thread.

#include <algorithm>
#include <cstdint>

#include "executor/faults/fault_bounds.h"

namespace tenon::executor {

class LeakyBucket {
 public:
  struct Parameters {
    double capacity = kLateCyclesMost;  ///< bad cycles at once that are one too many
    double leak = 0.05;  ///< per good cycle: one bad cycle in twenty can go on for ever
  };

  explicit LeakyBucket(const Parameters& parameters) : parameters_(parameters) {}

  void good() { level_ = std::max(0.0, level_ - parameters_.leak); }
  void bad(std::int64_t cycles) { level_ += static_cast<double>(cycles); }
  [[nodiscard]] bool full() const { return level_ >= parameters_.capacity; }
  [[nodiscard]] double level() const { return level_; }

 private:
  Parameters parameters_;
  double level_ = 0.0;
};

}  // namespace tenon::executor
