#pragma once
// Whether a cell can execute a plan, told before anything moves: every refusal is a line with both
// numbers. Set-up code; allocates; pure.

#include <string>
#include <vector>

#include "shared/cell/cell.h"
#include "shared/plan/plan.h"

namespace tenon::executor {

/// Joints keep at least this distance to their limits, m or rad.
inline constexpr double kJointMargin = 5e-3;

/// What the force can rise to when the tool meets the cell's stiffest contact at contact speed:
/// F_on + k_e v ((n + 1) T + tau_arm + M / D), N.
[[nodiscard]] double peak_force_N(const Cell& cell, const Compliance& compliance,
                                  const ParameterSet& set);

/// Empty where the cell can execute the plan. In order: latency, the two inequalities of the
/// compliance, peak force, sensor noise, axes, speeds, reach of the start and of every step.
[[nodiscard]] std::vector<std::string> check_plan(const Plan& plan, const Cell& cell);

}  // namespace tenon::executor
