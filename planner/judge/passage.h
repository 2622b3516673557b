#pragma once
// How a plan places a part before it goes in, in the middle of what lets it in. One thread; what it
// is given to run starts may have others.

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "planner/judge/judged_starts.h"
#include "planner/judge/validation.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// Runs starts through a plan, as run_starts() does.
using RunStarts = std::function<std::vector<Draw>(const Plan&, std::span<const JudgedStart>,
                                                  const std::function<bool(const Draw&)>& until)>;

/// From all over the reach. Those that do not arrive as it is count for nothing; where there are
/// none, the chains that are known stand for them.
struct PassageStarts {
  std::vector<JudgedStart> usual;
  std::vector<JudgedStart> extreme;  ///< tilted by as much as the plan is to hold
};

/// The plan with the last move after which the part stands free, to either side too, shifted across
/// the way from there to the middle of the shifts with which all usual starts still arrive, as far
/// as the extreme ones bear it. The search aims by the mean of its particles; at a hole it is the
/// farthest to either side that miss, and where the mean goes through they may all be on one. As it
/// comes back from its bytes; empty where that gains next to nothing.
/// @param plan at contact speed throughout  @param chains of the plan, all done  @param rollout
/// asked for collisions
[[nodiscard]] std::optional<Plan> with_passage_centred(const Plan& plan,
                                                       std::span<const Chain> chains,
                                                       const Task& task,
                                                       const PassageStarts& starts,
                                                       Rollout& rollout, const RunStarts& run);

}  // namespace tenon::planner
