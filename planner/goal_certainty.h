#pragma once
// How certain a goal has to be, where its task does not say.

#include "shared/ports/rollout.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// The task with goal_uncertainty_m2 from the room that the goal leaves: along each search
/// translation, and each rotation that has a tolerance of its own, the part can move so far either
/// way before it touches, at most the goal's tolerance; a standard deviation of half the narrowest
/// mean of the two, along every coordinate. A task that says its own is left as it is.
/// @param rollout asked for collisions
[[nodiscard]] Task with_goal_certainty(Task task, Rollout& rollout);

}  // namespace tenon::planner
