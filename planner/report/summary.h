#pragma once
// A planning run in words.

#include <string>
#include <vector>

#include "planner/judge/validation.h"
#include "planner/plan_report.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// "cost 8250, at most 2.04 times the optimum of the searched graph".
[[nodiscard]] std::string cost_text(const Plan& plan);

/// The plan's own estimate of its success: "190 of 200 draws end at the goal (95 %: 90.4 to 97.3
/// %), 176 of 176 within 2 sigma".
[[nodiscard]] std::string estimate_text(const Validation& validation, const Task& task);

/// Why the plan should not be relied on, where fewer than 95 % of the draws within reach can be
/// taken to end at the goal; else empty. "only 1 of 189 random starts within 3 sigma end ..."
[[nodiscard]] std::string doubt_text(const Validation& validation, const Task& task);

/// "16 of 16 starts 2 sigma out end at the goal, at friction 0.1 and 0.6".
[[nodiscard]] std::string corners_text(const Validation& validation, const Task& task);

/// A table with a line for each step: displacement, speeds, outcomes with envelopes, successors.
[[nodiscard]] std::string step_table(const Plan& plan);

/// "for the cell: CHANGE", a line for each of what fit_to_cell() changed.
[[nodiscard]] std::string cell_changes_text(const std::vector<std::string>& changes);

/// A dozen lines for people about a plan that was found.
[[nodiscard]] std::string summary(const PlanReport& report, const Task& task,
                                  const std::string& file);

/// A line for every draw that missed the goal: how unlikely its start was, and what stopped it.
[[nodiscard]] std::vector<std::string> missed(const PlanReport& report, const Task& task);

/// The largest force of any draw.
[[nodiscard]] double peak_force_N(const PlanReport& report);

}  // namespace tenon::planner
