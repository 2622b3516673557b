#pragma once
// Many starts drawn from the start's distribution, each run through the plan: what the particles on
// the belief's rim cannot say about its inside.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "planner/belief/rollout_pool.h"
#include "planner/judge/chain.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon::planner {

struct Draw {
  double mahalanobis = 0.0;  ///< how far out the start is, standard deviations
  Chain chain;
  bool at_goal = false;  ///< the plan was done and its tool within d_tol of the goal
};

struct Validation {
  std::vector<Draw> draws;
  /// Starts where drawing ends: along every uncertain coordinate both ways and to every corner
  /// between them, at both extremes of friction. Nobody drew them, so no statistic counts them;
  /// they show how far the plan's steps travel from starts that are hardly ever drawn.
  std::vector<Draw> rim;

  [[nodiscard]] std::size_t at_goal() const;
  /// Those within `sigmas` standard deviations, and how many of them ended at the goal.
  [[nodiscard]] std::size_t within(double sigmas) const;
  [[nodiscard]] std::size_t at_goal_within(double sigmas) const;

  /// Those that ended at the goal, the rim's too.
  [[nodiscard]] std::vector<Chain> good_chains() const;
  /// Guarded moves that were simulated for all of it.
  [[nodiscard]] std::size_t moves() const;
};

/// The draws by which a plan is judged are not those that refuted other paths, nor those that its
/// envelopes were widened to.
inline constexpr std::uint64_t kSearchSeed = 1;
inline constexpr std::uint64_t kEstimateSeed = 2;
inline constexpr std::uint64_t kEnvelopeSeed = 3;  ///< and the following ones

/// How many draws a plan is judged by.
inline constexpr std::size_t kDrawsMin = 200;
inline constexpr std::size_t kDrawsMax = 100'000;

struct ValidationParameters {
  std::size_t draws = kDrawsMin;
  std::uint64_t seed = kSearchSeed;
  /// Stop soon after a draw within the particles' reach that misses the goal: enough to refuse.
  bool stop_when_refuted = false;
};

/// Normal starts out to c_p + 1 standard deviations (farther ones, and those in collision, are
/// drawn again), friction even over the task's range. On the rim, starts in collision are left out.
[[nodiscard]] Validation validate(const Plan& plan, const Task& task, const Start& start,
                                  const ValidationParameters& parameters, RolloutPool& pool);

}  // namespace tenon::planner
