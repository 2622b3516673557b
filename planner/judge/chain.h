#pragma once
// A plan as one chain: a particle taken through every step, each from where the last one really
// ended, by the same transitions as in execution.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "shared/plan/transition.h"
#include "shared/ports/rollout.h"

namespace tenon::planner {

struct Chain {
  Particle start;
  std::vector<GuardedMove::Result> moves;          ///< of the steps that ran
  std::vector<std::size_t> steps;                  ///< their indices in the plan
  std::vector<std::vector<std::string>> touching;  ///< after each move, for people
  bool done = false;                               ///< the plan ended in kSuccessorDone
  std::string failure;  ///< otherwise why it stopped, in the last of the steps

  /// Where the tool rests after so many moves, in the task frame as it really stands.
  [[nodiscard]] Pose tool(std::size_t after) const {
    return after == 0 ? start.tool() : seen_from(start.environment, moves[after - 1].pose);
  }
  /// Where it rests now, likewise.
  [[nodiscard]] Pose end() const { return tool(moves.size()); }
};

[[nodiscard]] Chain run_chain(Rollout& rollout, const Plan& plan, const Particle& start,
                              std::int64_t step_us);

/// The same decisions on moves that were made before; nothing is simulated.
/// @return the index into moves where the plan would have stopped; moves.size() where nowhere
[[nodiscard]] std::size_t first_deviation(const Plan& plan, const Chain& chain);

/// "contact after x, outside its envelope", for people.
[[nodiscard]] std::string describe(const Transition& transition, const GuardedMove::Result& move);

}  // namespace tenon::planner
