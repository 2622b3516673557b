#pragma once
// Where uncertainty shrinks: beliefs after long pushes, found with a few dozen rollouts, and the
// guides that lead from one to the next.

#include <vector>

#include "planner/heuristics.h"
#include "planner/successor.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// Long pushes along one search axis after the other, from the start and with the start's spread
/// about the goal. A push is a contact attractor where the particles then stand within c_u times
/// their spread before it. Guides are the cheapest sequences of contacts that leave no more than
/// the goal's uncertainty (or the most certain ones, where none does), and, with the cheapest of
/// them, the mouth of a hole: where a tool drawn out of the goal along a contact loses it.
/// @param succ with moves at approach speed and time for long ones
/// @param rollout asked for collisions only
[[nodiscard]] std::vector<Guide> find_guides(const Task& task, const Belief& start,
                                             SuccessorEngine& succ, Rollout& rollout);

}  // namespace tenon::planner
