#pragma once
// Where a start has no plan: whether its errors are why. Plans again with a part of them, which
// says what would have to be known better, or that nothing of that kind would help.

#include <string>

#include "planner/planner.h"

namespace tenon::planner {

/// Plans with a quarter of the start's errors, and if that has a plan with half of them, then with
/// three quarters. It takes at most half as long as planning has taken, at least 2 s, and half of
/// the moves that were allowed. Arguments as for make_plan().
/// @param failed what make_plan() came to
/// @return what follows the reason, "; with half of its errors (sigma_m: [0.015, 0.015]) it has a
/// plan, with three quarters none was found"; empty where errors cannot be why, and for baselines
[[nodiscard]] std::string smaller_errors_text(const PlanReport& failed, const Task& task,
                                              const Start& start, const Rollout& rollout,
                                              const PlannerOptions& options,
                                              const ClockSeconds& now_s);

}  // namespace tenon::planner
