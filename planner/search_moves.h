#pragma once
// The parameters of the moves that the search simulates: those of a plan's step, as the file has
// them, so that what is searched is what is written. Pure; any thread.

#include "planner/judge/plan_draft.h"
#include "shared/motion/move_parameters.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// Everything of the search's moves but their displacement: that of a plan's step, as the file has
/// it.
[[nodiscard]] MoveParameters search_move(const Task& task, const Start& start,
                                         const CellAssumptions& assumptions);

/// Likewise of the long moves that only look for attractors: as fast as the task allows, with the
/// time that they need. @param move what search_move() says
[[nodiscard]] MoveParameters long_move(const Task& task, MoveParameters move);

}  // namespace tenon::planner
