#include "planner/search_moves.h"

#include <algorithm>
#include <array>

#include "planner/belief/primitives.h"

namespace tenon::planner {

MoveParameters search_move(const Task& task, const Start& start,
                           const CellAssumptions& assumptions) {
  const std::array<Vector6, 1> displacement = {step_primitives(task).front().displacement};
  return move_parameters(draft_plan(task, start, assumptions, displacement), 0);
}

MoveParameters long_move(const Task& task, MoveParameters move) {
  move.slow_from_m = task.long_step_m;
  constexpr double kLongest_s = 4000.0;
  const double time_s = 2.0 + 1.5 * task.long_step_m / move.speeds.approach_mps;
  move.timeout_us = static_cast<std::uint32_t>(1e6 * std::min(time_s, kLongest_s));
  return move;
}

}  // namespace tenon::planner
