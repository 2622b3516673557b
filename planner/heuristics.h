#pragma once
// Costs and heuristics of the belief search. Pure; any thread.

#include <optional>
#include <vector>

#include "planner/belief.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// What a belief is to costs and heuristics.
struct BeliefSummary {
  Pose mean;
  double uncertainty_m2 = 0.0;
  double farthest_m = 0.0;           ///< distance to the goal of the particle farthest from it
  Vector6 spread = Vector6::Zero();  ///< by axis, of the particle farthest from the mean, m or rad
  bool inserted = true;              ///< every particle is where the task wants it inserted
};

[[nodiscard]] BeliefSummary summarise(const Belief& belief, const Task& task);

/// A push along one axis after which the particles stand together along it: contact with a face, or
/// the loss of one at its edge.
struct ContactAttractor {
  int axis = 0;
  Pose mean;            ///< of the belief after the push
  double spread = 0.0;  ///< along the axis after the push, m or rad
  double uncertainty_m2 = 0.0;
  /// Where a push must begin that would miss a small face from elsewhere; the coordinate along the
  /// axis does not count. Empty for a face that may be met anywhere.
  std::optional<Pose> via;
};

/// Where an inadmissible heuristic leads: to contacts in turn, then past goal attractors, of which
/// the last is the goal.
struct Guide {
  std::vector<ContactAttractor> contacts;
  std::vector<Pose> goals;
  /// What the contacts cost is several times what the anchor knows of, and a guide leads only while
  /// it is within w2 of the anchor: so that part of it is scaled down to begin there.
  double contact_scale = 1.0;
};

/// c(s, s') = w_d d(s, s') + w_u u(s) + w_m.
[[nodiscard]] double edge_cost(const BeliefSummary& from, const BeliefSummary& to,
                               const Task& task);

/// d(mean, goal) <= d_tol, u <= u_tol, and every particle by itself within d_tol and inserted.
[[nodiscard]] bool at_goal(const BeliefSummary& belief, const Task& task);

/// 0 at the goal, else w_d max(0, d(s, goal) - d_tol) + w_u u(s) + w_m. Consistent: the last two
/// terms cancel against the edge's own, and the rest is a distance to a ball that holds every goal.
[[nodiscard]] double anchor_heuristic(const BeliefSummary& belief, const Task& task);

/// What is left to pay by single steps along the guide: w_d for the way, and w_m + w_u u for every
/// step at the uncertainty that the last contact left. A contact is behind a belief whose particles
/// stand together along its axis. Inadmissible.
[[nodiscard]] double foliated_heuristic(const BeliefSummary& belief, const Guide& guide,
                                        const Task& task);

}  // namespace tenon::planner
