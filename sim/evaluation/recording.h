#pragma once
// A run as a page replays it: where the part really was, and what the executor felt, at moments
// far enough apart that any run fits. Plain data but for add(), which allocates.

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "shared/math/pose.h"

namespace tenon::sim {

/// What is known at the end of a moment.
struct Moment {
  std::int64_t time_ns = 0;  ///< since the plan began
  Pose tool;                 ///< by the truth, in the frame of the environment as it really stands
  /// By the executor, task axes at the tool, N and Nm: on each axis the largest since the last
  /// moment.
  Vector6 wrench = Vector6::Zero();
  int step = 0;                    ///< of the plan
  std::set<std::string> touching;  ///< shapes of the environment, by the truth
};

class Recording {
 public:
  static constexpr std::int64_t kPeriodLeast_ns = 20'000'000;
  static constexpr std::size_t kMomentsMax = 300;

  /// One cycle. @param wrench what was felt in it
  void feel(const Vector6& wrench);
  /// Whether this cycle ends a moment.
  [[nodiscard]] bool is_due(std::int64_t time_ns) const;
  /// Ends a moment; its wrench is what was felt since the last one. Where there are too many, two
  /// become one and the period doubles. @pre time_ns is above that of the last
  void add(Moment moment);

  [[nodiscard]] const std::vector<Moment>& moments() const { return moments_; }

 private:
  std::vector<Moment> moments_;
  Vector6 felt_ = Vector6::Zero();
  std::int64_t period_ns_ = kPeriodLeast_ns;
};

}  // namespace tenon::sim
