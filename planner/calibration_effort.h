#pragma once
// For how long plans are looked for that bear what calibration leaves, in simulated moves, before
// less is all that is held. One thread.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "planner/belief/successor.h"

namespace tenon::planner {

class CalibrationEffort {
 public:
  /// From now on a smaller tilt is held, if any was held before, and looked for kMoreForLess times
  /// as long: there is less and less to give up instead.
  /// @param moves simulated so far, as everywhere here  @param search counters of the search
  void begin(std::uint64_t moves, const SuccessorEngine::Counters& search) {
    if (refuted()) {
      searched_before_ = search.rollouts + search.memo_hits;
      allowed_ *= kMoreForLess;
    }
    began_at_ = moves;
    refuted_at_.reset();
    paths_ = 0;
  }

  /// A path was refuted. @param by_calibration see Refutation  @param steps of the path
  void refute(bool by_calibration, std::size_t steps, std::uint64_t moves) {
    if (!by_calibration) return;
    if (allowed_ == 0) allowed_ = std::max<std::uint64_t>(moves - began_at_, kRunsOfAPath * steps);
    refuted_at_ = moves;
    ++paths_;
  }

  [[nodiscard]] bool refuted() const { return refuted_at_.has_value(); }
  /// Once the tilt has refuted a path, another is looked for with as many moves again as it took to
  /// find and refute the first path that any tilt refuted, or as kRunsOfAPath runs of that path
  /// take where that is more, and so on from each that is found and refuted, up to kPathsMax of
  /// them; for as many times longer as begin() says.
  [[nodiscard]] bool spent(std::uint64_t moves) const {
    return refuted() && (paths_ >= kPathsMax || moves >= *refuted_at_ + allowed_);
  }

  /// Moves of the search with this tilt: those that a larger one has left known are among them.
  [[nodiscard]] std::uint64_t searched(const SuccessorEngine::Counters& search) const {
    if (!searched_before_) return search.rollouts;
    return search.rollouts + search.memo_hits - *searched_before_;
  }

 private:
  static constexpr int kPathsMax = 8;
  /// A plan that holds is judged by six times as many.
  static constexpr std::uint64_t kRunsOfAPath = 100;
  static constexpr std::uint64_t kMoreForLess = 10;

  std::uint64_t began_at_ = 0;
  std::optional<std::uint64_t> refuted_at_;  ///< the last time
  std::uint64_t allowed_ = 0;
  int paths_ = 0;
  std::optional<std::uint64_t> searched_before_;  ///< with larger tilts
};

}  // namespace tenon::planner
