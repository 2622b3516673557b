#include "planner/judge/last_move.h"

#include <algorithm>

#include "planner/belief/primitives.h"
#include "planner/judge/plan_draft.h"
#include "shared/task/inserted.h"

namespace tenon::planner {
namespace {

constexpr double kWorthOfTolerance = 0.1;

/// Nothing pushes there on where the tool comes to rest.
bool ends_free(const Plan& plan, const Chain& chain) {
  return !chain.steps.empty() && chain.steps.back() + 1 == plan.steps.size() &&
         chain.moves.back().outcome == Outcome::kReached && chain.touching.back().empty();
}

/// From the goal to the middle of all ends, in the search's coordinates.
Vector6 off_centre(std::span<const Chain> chains, const Task& task) {
  Vector6 low = displacement_between(task.goal, chains.front().end());
  Vector6 high = low;
  for (const Chain& chain : chains) {
    const Vector6 off = displacement_between(task.goal, chain.end());
    low = low.cwiseMin(off);
    high = high.cwiseMax(off);
  }
  Vector6 off = 0.5 * (low + high);
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(task.coordinates, axis) || has(task.goal_axes.free, axis)) off[axis] = 0.0;
  }
  return off;
}

}  // namespace

std::optional<Plan> with_last_move_centred(const Plan& plan, std::span<const Chain> chains,
                                           const Task& task) {
  const auto free = [&](const Chain& chain) { return ends_free(plan, chain); };
  if (chains.empty() || !std::all_of(chains.begin(), chains.end(), free)) return std::nullopt;
  const Vector6 off = off_centre(chains, task);
  if (tolerances_from_goal(task, displaced(task.goal, off)) < kWorthOfTolerance)
    return std::nullopt;
  Plan centred = plan;
  Step& last = centred.steps.back();
  const double before_m = last.displacement.head<3>().norm();
  const Vector6 back = in_move_axes(task, chains.front().end(), off);
  for (int axis = 0; axis < 6; ++axis) {
    if (has(moved_axes(task), axis)) last.displacement[axis] -= back[axis];
  }
  const double after_m = last.displacement.head<3>().norm();
  last.slow_from_m = last.slow_from_m < before_m ? std::min(last.slow_from_m, after_m) : after_m;
  return through_bytes(centred);
}

}  // namespace tenon::planner
