#pragma once
// Costs and heuristics of the belief search. Pure; any thread.

#include <vector>

#include "planner/belief.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// What a belief is to costs and heuristics.
struct BeliefSummary {
  Pose mean;
  double uncertainty_m2 = 0.0;
  double farthest_m = 0.0;  ///< distance to the goal of the particle farthest from it
};

[[nodiscard]] BeliefSummary summarise(const Belief& belief, const Task& task);

/// Where a guide leads: to `contact` while the uncertainty is above the goal's, then to `goal`.
struct Attractor {
  Pose contact;
  Pose goal;
};

/// c(s, s') = w_d d(s, s') + w_u u(s).
[[nodiscard]] double edge_cost(const BeliefSummary& from, const BeliefSummary& to,
                               const Task& task);

/// d(mean, goal) <= d_tol, u <= u_tol, and every particle by itself within d_tol.
[[nodiscard]] bool at_goal(const BeliefSummary& belief, const Task& task);

/// 0 at the goal, else w_d max(0, d(s, goal) - d_tol) + w_u u(s). Consistent: the term in u cancels
/// against the edge's own, and the rest is a distance to a ball that holds every goal.
[[nodiscard]] double anchor_heuristic(const BeliefSummary& belief, const Task& task);

/// w_d d(s, attractor) + w_u u(s). Inadmissible.
[[nodiscard]] double foliated_heuristic(const BeliefSummary& belief, const Attractor& attractor,
                                        const Task& task);

}  // namespace tenon::planner
