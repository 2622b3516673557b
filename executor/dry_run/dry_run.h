#pragma once
// A whole plan gone through with a cell's arm before anything is powered: every step over all that
// its envelopes allow, from one start position of the joints on. It finds that start, slows steps
// that ask a joint for too much, and refuses what no slowing helps, naming step, joint and number.
// Set-up code; allocates; pure. Links and task are not checked for collisions.

#include <optional>
#include <string>
#include <vector>

#include "executor/dry_run/step_walk.h"
#include "shared/cell/cell.h"
#include "shared/plan/plan.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

struct DryRun {
  std::vector<std::string> refusals;  ///< empty where the arm can execute the plan
  /// Where the joints stand as the plan begins; empty where the start is out of reach.
  std::optional<JointVector> start;
  std::vector<StepDemand> steps;  ///< those that some way leads to, up to a refused one
  Plan plan;                      ///< slowed where it has to be: what is executed
};

/// Tries the start positions one after the other until the plan fits one without being slowed; else
/// takes the one that is slowed least, else the one that gets furthest.
[[nodiscard]] DryRun dry_run(const Plan& plan, const Cell& cell);

}  // namespace tenon::executor
