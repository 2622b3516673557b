#pragma once
// The moves that a guide suggests to a belief: larger than steps, and not on the lattice. Pure; any
// thread.

#include <vector>

#include "planner/belief/belief_summary.h"
#include "planner/belief/primitives.h"
#include "planner/search/guide.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// Labels of these moves begin here.
inline constexpr int kGuideLabel = 1000;

/// How far a move along one axis gets within its time limit, m or rad: what is farther off guides
/// nobody.
[[nodiscard]] double longest_move(const Task& task, int axis);

/// To the next contact that is not behind the belief: along each axis alone, and along all of them
/// but the push's own, to where the push begins; and the push, as far as the farthest particle
/// needs. To every place that the guide leads to afterwards: along each axis alone, and across to
/// it with one axis left out. Moves that are too short to measure, or too long for the time limit
/// of a move, are left out, and none comes twice. Numbered in order.
[[nodiscard]] std::vector<Primitive> guide_moves(const Task& task, const BeliefSummary& belief,
                                                 const std::vector<Guide>& guides);

}  // namespace tenon::planner
