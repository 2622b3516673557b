#pragma once
// Heuristics of the belief search: the anchor that keeps the bound, and those that the guides make.
// Pure; any thread.

#include "planner/belief/belief_summary.h"
#include "planner/search/guide.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// 0 at the goal, else w_d max(0, d(s, goal) - d_tol) + w_u u(s) + w_m. Consistent: the last two
/// terms cancel against the edge's own, and the rest is a distance to a ball that holds every goal.
[[nodiscard]] double anchor_heuristic(const BeliefSummary& belief, const Task& task);

/// Whether a belief's particles stand together along a contact's axis: the contact is behind it.
[[nodiscard]] bool is_behind(const BeliefSummary& belief, const ContactAttractor& contact,
                             const Task& task);

/// What is left to pay along the guide: w_d for the way, and w_m + w_u u for every step at the
/// uncertainty that the last contact left, or for every move where the guides suggest moves. A
/// contact is behind a belief whose particles stand together along its axis. Inadmissible.
[[nodiscard]] double foliated_heuristic(const BeliefSummary& belief, const Guide& guide,
                                        const Task& task);

}  // namespace tenon::planner
