#pragma once
// Where uncertainty shrinks: beliefs after long pushes, found with a few dozen rollouts.

#include <vector>

#include "planner/heuristics.h"
#include "planner/successor.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// Forward: long primitives, and pairs of them, from the start; an end is an attractor where its
/// uncertainty is below c_u times that of the start. Backward: long primitives from the goal with
/// the start's spread give contact attractors by the same rule; from the goal as a point, a move
/// that ends by losing a contact gives a goal attractor, such as the mouth of a hole.
/// Near-duplicates are dropped; the eight that are the least detour from start to goal stay, in a
/// fixed order.
/// @param succ with moves at approach speed and time for long ones
/// @param rollout asked for collisions only
[[nodiscard]] std::vector<Attractor> find_attractors(const Task& task, const Belief& start,
                                                     SuccessorEngine& succ, Rollout& rollout);

}  // namespace tenon::planner
