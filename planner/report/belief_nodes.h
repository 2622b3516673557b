#pragma once
// How the belief shrinks along a plan: what its chains stand for after each number of steps. Pure;
// any thread.

#include <vector>

#include "planner/judge/chain.h"
#include "planner/judge/validation.h"
#include "shared/task/task.h"

namespace tenon::planner {

struct BeliefNode {
  Vector6 spread = Vector6::Zero();  ///< standard deviation an axis, m or rad
  double uncertainty_m2 = 0.0;
};

/// Before the first step, and after each step that all chains ran; empty without chains.
[[nodiscard]] std::vector<BeliefNode> nodes_of(const std::vector<Chain>& chains, const Task& task);

/// The chains of the draws that went through the whole plan.
[[nodiscard]] std::vector<Chain> finished(const Validation& validation);

}  // namespace tenon::planner
