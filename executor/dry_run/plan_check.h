#pragma once
// Whether a cell's forces and delays suit a plan, told before anything moves: every refusal is a
// line with both numbers. Joints are dry_run.h's. Set-up code; allocates; pure.

#include <string>
#include <vector>

#include "shared/cell/cell.h"
#include "shared/plan/plan.h"

namespace tenon::executor {

/// Empty where the cell can execute the plan. In order: latency, the two inequalities of the
/// compliance, those of its rotations, peak force and sensor noise (and torque), contacts that
/// would not be noticed, an end that is not about the goal.
[[nodiscard]] std::vector<std::string> check_plan(const Plan& plan, const Cell& cell);

}  // namespace tenon::executor
