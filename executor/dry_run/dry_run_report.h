#pragma once
// A dry run for people and for machines. Allocates.

#include <string>

#include "executor/dry_run/dry_run.h"
#include "shared/cell/cell.h"

namespace tenon::executor {

/// Where the joints begin, and a line a step: the joint that comes nearest to a limit, its room to
/// stop counted, the most that a joint is asked for, the smallest conditioning, the slow-down. Then
/// the refusals.
[[nodiscard]] std::string to_table(const DryRun& run, const Cell& cell);

/// The same; README.md names the keys.
[[nodiscard]] std::string to_json(const DryRun& run, const Plan& plan, const Cell& cell);

/// Where the joints' efforts tell the force, a line for each step: how finely, by axis.
[[nodiscard]] std::string resolved_steps(const DryRun& run, const Cell& cell);

/// "step 3 runs at 0.62 of its speed: ...", a line a slowed step; empty where none is.
[[nodiscard]] std::string slowed_steps(const DryRun& run, const Cell& cell);

}  // namespace tenon::executor
