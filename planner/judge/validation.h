#pragma once
// Many starts, each run through the plan: what the particles on the belief's rim cannot say about
// its inside, and about the corners of what the task leaves open.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "planner/belief/rollout_pool.h"
#include "planner/judge/chain.h"
#include "planner/judge/judged_starts.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon::planner {

struct Draw {
  double sigmas_out = 0.0;  ///< how far out the start is, see shared/task/spread.h
  Chain chain;
  /// The plan was done and its tool inserted, within d_tol of the goal. Else the draw counts as
  /// missed.
  bool at_goal = false;
};

struct Validation {
  std::vector<Draw> draws;
  /// corner_starts(): nobody drew them, so no statistic counts them, but a plan has to hold there.
  std::vector<Draw> corners;
  /// rim_starts(): beyond what a plan has to hold for. They show how far its steps travel from
  /// starts that are hardly ever drawn.
  std::vector<Draw> rim;
  /// Of corners and rim: what the plan holds of the task's at all corners. The draws have all of
  /// it.
  CalibrationErrors held;

  [[nodiscard]] std::size_t at_goal() const;
  /// Those at most `sigmas` standard deviations out, and how many of them ended at the goal.
  [[nodiscard]] std::size_t within(double sigmas) const;
  [[nodiscard]] std::size_t at_goal_within(double sigmas) const;
};

/// The first of them within so many standard deviations that missed the goal; null where all of
/// these met it.
[[nodiscard]] const Draw* missed_draw(std::span<const Draw> draws, double sigmas);
/// How many of them ended at the goal.
[[nodiscard]] std::size_t arrived(std::span<const Draw> draws);
/// The chains of those that ended at the goal.
[[nodiscard]] std::vector<Chain> good_chains(std::span<const Draw> draws);

/// The draws by which a plan is judged are none that its search or its envelopes have seen, nor any
/// that somebody could look at while the planner is made: their seed comes from the plan itself,
/// all of its bytes but what judging writes into them (cost, bound, counts).
[[nodiscard]] std::uint64_t judging_seed(const Plan& plan);
inline constexpr std::uint64_t kSearchSeed = 1;
inline constexpr std::uint64_t kEnvelopeSeed = 3;  ///< and the following ones

/// How many draws a plan is judged by.
inline constexpr std::size_t kDrawsMin = 200;
inline constexpr std::size_t kDrawsMax = 100'000;

/// Runs the starts through the plan, in their order.
/// @param until true of a draw: those behind it are left out, the same at any number of threads
[[nodiscard]] std::vector<Draw> run_starts(const Plan& plan, const Task& task,
                                           std::span<const JudgedStart> starts, RolloutPool& pool,
                                           const std::function<bool(const Draw&)>& until = {});

/// Runs as many starts again as it takes to find one that misses, all where none does. Those that
/// miss are neighbours mostly, so they are run in an order in which neighbours are far apart.
/// @param sigmas see missed_draw()  @param at_once so many are run before a look at them
/// @param run starts through a plan  @return what was run, in the order of the starts
[[nodiscard]] std::vector<Draw> run_past_miss(
    std::span<const JudgedStart> starts, double sigmas, std::size_t at_once,
    const std::function<std::vector<Draw>(std::span<const JudgedStart>)>& run);

/// Corners and rim, with the first of errors_to_hold() that holds at all corners, or the last.
/// A baseline has all of the task's, which it holds or not.
/// @param rollout asked for collisions  @param run starts through the plan
void hold_extremes(const Plan& plan, const Task& task, const Start& start, Rollout& rollout,
                   Validation& validation,
                   const std::function<std::vector<Draw>(std::span<const JudgedStart>)>& run);

/// All that a finished plan is judged by, from the file alone.
[[nodiscard]] Validation validate(const Plan& plan, const Task& task, const Start& start,
                                  std::size_t draws, RolloutPool& pool);

/// What has been run through a plan, as the same plan with other rules would have gone on with it.
/// Nothing is simulated. @param plan with the same displacements and speeds
[[nodiscard]] std::vector<Draw> decided_by(const Plan& plan, const Task& task,
                                           std::span<const Draw> draws);

}  // namespace tenon::planner
