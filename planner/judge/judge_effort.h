#pragma once
// What judging takes, by its parts. Plain data; any thread.

#include <cstdint>

namespace tenon::planner {

/// Guarded moves run, also those that were known (remembered_rollout.h), and how long that took.
struct Effort {
  std::uint64_t moves = 0;
  double time_s = 0.0;
};

struct JudgeEffort {
  Effort certification;
  Effort corners;     ///< starts on the rim of the reach, which may refute
  Effort validation;  ///< draws, and starts beyond the reach

  [[nodiscard]] std::uint64_t moves() const {
    return certification.moves + corners.moves + validation.moves;
  }
  [[nodiscard]] double time_s() const {
    return certification.time_s + corners.time_s + validation.time_s;
  }
};

}  // namespace tenon::planner
