#include "executor/sensing/effort_watch.h"

#include <algorithm>
#include <cmath>

#include "executor/sensing/repetition.h"

namespace tenon::executor {

EffortWatch::EffortWatch(const Cell& cell)
    : count_(cell.robot.joints.size()), identified_(!cell.joint_torque->joints.empty()) {
  for (std::size_t i = 0; i < count_; ++i) {
    const double counts = std::abs(cell.robot.joints[i].counts_per_unit);
    watched_[i].moves = counts > 0.0 ? kMoves_counts / counts : 0.0;
    if (identified_) watched_[i].residual = cell.joint_torque->joints[i].residual;
  }
}

void EffortWatch::begin_tare() {
  taring_ = true;
  for (Watched& watched : watched_) watched.pairs = watched.repeats = watched.cycles_max = 0;
}

void EffortWatch::end_tare() {
  taring_ = false;
  for (std::size_t i = 0; i < count_; ++i) {
    Watched& watched = watched_[i];
    if (watched.pairs < kPairsLeast) continue;
    watched.cycles_max =
        equal_samples_most(watched.repeats, watched.pairs, 0.0, kFrozenEffortCycles - 1);
  }
}

void EffortWatch::let_go() { known_ = taring_ = false; }

std::optional<EffortWatch::Frozen> EffortWatch::update(const ArmFeedback& feedback,
                                                       const JointVector& commanded,
                                                       const JointVector& external) {
  std::optional<Frozen> first;
  for (std::size_t i = 0; i < count_; ++i) {
    Watched& watched = watched_[i];
    const bool repeats = known_ && feedback.effort[i] == watched.effort;
    if (known_ && taring_) {
      ++watched.pairs;
      watched.repeats += repeats ? 1 : 0;
    }
    watched.effort = feedback.effort[i];
    const bool moves = std::abs(feedback.position[i] - watched.position) >= watched.moves ||
                       std::abs(commanded[i] - watched.commanded) >= watched.moves;
    if (!repeats || moves) {
      watched.position = feedback.position[i];
      watched.commanded = commanded[i];
    }
    if (!repeats) {
      watched.same = watched.cycles = 0;
      watched.has_model = false;
      continue;
    }
    // The mean of two efforts is in what is left: it stands still from the second one on.
    if (!watched.has_model) watched.smoothed = watched.low = watched.high = external[i];
    watched.has_model = true;
    watched.smoothed += (external[i] - watched.smoothed) / kSmoothed;
    watched.low = std::min(watched.low, watched.smoothed);
    watched.high = std::max(watched.high, watched.smoothed);
    ++watched.same;
    watched.cycles += moves ? 1 : 0;
    if (!first && moves && is_frozen(watched)) first = Frozen{static_cast<int>(i), watched.cycles};
  }
  known_ = true;
  return first;
}

bool EffortWatch::is_frozen(const Watched& watched) const {
  if (watched.cycles_max > 0 && watched.cycles > watched.cycles_max) return true;
  return identified_ && watched.same >= kFrozenEffortCycles && watched.cycles >= kSmoothed &&
         watched.high - watched.low > kSure * watched.residual;
}

}  // namespace tenon::executor
