#pragma once
// The parameters of the moves that the search simulates: those of a plan's step, as the file has
// them, so that what is searched is what is written. Pure; any thread.

#include <cstdint>
#include <optional>
#include <string>

#include "planner/belief/move_reach.h"
#include "planner/cell_fit/cell_assumptions.h"
#include "shared/motion/move_parameters.h"
#include "shared/ports/arm_reach.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// What is assumed of the cell: what was told, else what the task says; as a plan file holds it.
[[nodiscard]] CellAssumptions stored_assumptions(const Task& task,
                                                 const std::optional<CellAssumptions>& told);

/// Everything of the search's moves but their displacement: that of a plan's step, as the file has
/// it.
[[nodiscard]] MoveParameters search_move(const Task& task, const Start& start,
                                         const CellAssumptions& assumptions);

/// Where nothing turns, the search looks at moves with twice the step of what is judged, in half
/// the time; a path that holds by that alone is refuted like any other. A part that aligns with
/// what it meets does otherwise with longer steps.
[[nodiscard]] std::int64_t search_step_us(const Task& task);

/// What of the search's moves the arm can make.
/// @param why set to one line where there is nothing to ask: the arm cannot hold the start, or the
/// goal
[[nodiscard]] std::optional<MoveReach> reach_of_moves(const Task& task, const Start& start,
                                                      const CellAssumptions& assumptions,
                                                      const ArmReach& reach, std::string& why);

/// Likewise of the long moves that only look for attractors: as fast as the task allows, with the
/// time that they need. @param move what search_move() says
[[nodiscard]] MoveParameters long_move(const Task& task, MoveParameters move);

}  // namespace tenon::planner
