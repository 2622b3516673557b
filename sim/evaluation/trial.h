#pragma once
// One run of an evaluation: what the world is in it, and what came of it. Plain data.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "shared/cell/cell.h"
#include "shared/experiment/world_ranges.h"
#include "shared/task/task.h"
#include "sim/cell/virtual_arm/world_draw.h"

namespace tenon::sim {

/// What is drawn. Follows from the evaluation's seed and the run's number alone, so that every plan
/// meets the same worlds, and one run can be made again by itself.
struct Trial {
  std::size_t number = 0;
  /// Of offset, world and sensor noise; the same as tenon-sim's --seed.
  std::uint64_t seed = 0;
  Vector6 offset = Vector6::Zero();  ///< of the environment, in task axes, m and rad
  double distance = 0.0;             ///< of the offset, Mahalanobis: in standard deviations
  double tilt_rad = 0.0;             ///< of the world, see tilt_of()
  WorldDraw world;
};

/// What came of it.
struct TrialResult {
  bool done = false;     ///< the executor says that the plan is done
  bool at_goal = false;  ///< the truth says so
  std::string ending;    ///< the executor's name for it, or kNoWorld, kNoPhysics
  std::string reason;    ///< one line
  int step = -1;         ///< the last one that ran
  std::string outcome;   ///< of that step; empty: it was cut short
  std::size_t steps = 0;
  double duration_s = 0.0;  ///< of the executor's cycles
  // From the simulator's truth; unset where there was no run.
  std::optional<Vector6> error;  ///< from the goal to the tool, in the axes of the real environment
  double contact_force_N_max = 0.0;  ///< at any instant
  /// Where the tool was as the plan began, after each step, and at the end, um exact: m, in the
  /// frame of the environment as it really stands. The end alone where no plan began.
  std::vector<Vector3> path_m;
};

/// The drawn world cannot be: the part stands in the environment before anything moves.
inline constexpr const char* kNoWorld = "no_such_world";
/// The solver gave up: what it says about the run means nothing.
inline constexpr const char* kNoPhysics = "physics_failed";

enum class TrialClass : std::uint8_t {
  kSucceeded = 0,     ///< done, and at the goal
  kStopped = 1,       ///< with a reason that has a name
  kDoneButWrong = 2,  ///< nobody noticed
};
[[nodiscard]] const char* to_string(TrialClass trial_class);

[[nodiscard]] inline TrialClass classify(const TrialResult& result) {
  if (!result.done) return TrialClass::kStopped;
  return result.at_goal ? TrialClass::kSucceeded : TrialClass::kDoneButWrong;
}

struct Run {
  Trial trial;
  TrialResult result;
};

/// What calibration has turned about axes that are no coordinates, of the environment and of the
/// part in the hand together: what the task's tilt_rad bounds. Of what moves go along, nothing.
[[nodiscard]] double tilt_of(const WorldDraw& world, const Task& task, const Cell& cell);

/// Whether a plan for the task promises to hold there: start and tilt are within the task's bounds.
[[nodiscard]] bool within_promise(const Trial& trial, const Task& task);

/// ", tilted by 0.26 degrees"; empty where the world is not tilted.
[[nodiscard]] std::string tilt_text(const Trial& trial);

/// @param ranges null: the offset alone is drawn
[[nodiscard]] Trial draw_trial(const Task& task, const Cell& cell, const Start& start,
                               const WorldRanges* ranges, std::uint64_t seed, std::size_t number);

}  // namespace tenon::sim
