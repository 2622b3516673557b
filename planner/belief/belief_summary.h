#pragma once
// A belief in the few numbers that the search is about, what it costs to leave it, and whether it
// is at the goal. Pure; any thread.

#include "planner/belief/belief.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// What a belief is to costs and heuristics.
struct BeliefSummary {
  Pose mean;  ///< its rotations that are no coordinate are the goal's
  double uncertainty_m2 = 0.0;
  double farthest_m = 0.0;           ///< distance to the goal of the particle farthest from it
  double farthest = 0.0;             ///< the same in the goal's tolerances
  Vector6 spread = Vector6::Zero();  ///< by axis, of the particle farthest from the mean, m or rad
  bool inserted = true;              ///< every particle is where the task wants it inserted
};

[[nodiscard]] BeliefSummary summarise(const Belief& belief, const Task& task);

/// What a move costs beside its way: w_m + w_u u.
[[nodiscard]] double move_cost(const Task& task, double uncertainty_m2);

/// c(s, s') = w_d d(s, s') + w_u u(s) + w_m.
[[nodiscard]] double edge_cost(const BeliefSummary& from, const BeliefSummary& to,
                               const Task& task);

/// The mean and every particle by itself within half of the goal's tolerances, u <= u_tol, and all
/// inserted: the other half is the arm's.
[[nodiscard]] bool at_goal(const BeliefSummary& belief, const Task& task);

}  // namespace tenon::planner
