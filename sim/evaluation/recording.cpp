#include "sim/evaluation/recording.h"

#include <algorithm>
#include <utility>

namespace tenon::sim {
namespace {

/// On each axis the one that is farther from zero.
Vector6 larger(const Vector6& a, const Vector6& b) {
  return (a.array().abs() >= b.array().abs()).select(a, b);
}

}  // namespace

void Recording::feel(const Vector6& wrench) { felt_ = larger(felt_, wrench); }

bool Recording::is_due(std::int64_t time_ns) const {
  return moments_.empty() || time_ns >= moments_.back().time_ns + period_ns_;
}

void Recording::add(Moment moment) {
  moment.wrench = std::exchange(felt_, Vector6::Zero());
  moments_.push_back(std::move(moment));
  if (moments_.size() <= kMomentsMax) return;
  // The first stands for itself: it is where the part began.
  std::size_t kept = 1;
  for (std::size_t i = 1; i < moments_.size(); i += 2) {
    const std::size_t last = std::min(i + 1, moments_.size() - 1);
    Moment both = std::move(moments_[last]);
    both.wrench = larger(both.wrench, moments_[i].wrench);
    moments_[kept++] = std::move(both);
  }
  moments_.resize(kept);
  period_ns_ *= 2;
}

}  // namespace tenon::sim
