#pragma once
// Where a plan ends, in the middle of its goal. Pure; any thread.

#include <optional>
#include <span>

#include "planner/judge/chain.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// The plan with its last displacement moved, in the search's coordinates, so that the ends of the
/// chains farthest apart lie about the goal evenly. The search aims by its particles' mean, in one
/// physics and at one speed; where friction drags on the way, the ends are off to one side then. As
/// it comes back from its bytes; empty where that gains less than a tenth of the goal's tolerance,
/// or where the last move touches anything.
/// @param chains of the plan, all done
[[nodiscard]] std::optional<Plan> with_last_move_centred(const Plan& plan,
                                                         std::span<const Chain> chains,
                                                         const Task& task);

}  // namespace tenon::planner
