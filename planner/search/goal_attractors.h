#pragma once
// Where the search may move to straight, since a lattice lands on neither: the goal, and the mouth
// of the hole that it lies in.

#include <vector>

#include "planner/belief/successor.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// The goal, and where there is one the place just outside of where a tool drawn straight out of it
/// along a contact loses that contact.
/// @param succ with moves at approach speed and time for long ones
[[nodiscard]] std::vector<Pose> goal_attractors(const Task& task, const Belief& start,
                                                SuccessorEngine& succ);

}  // namespace tenon::planner
