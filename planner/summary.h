#pragma once
// A planning run in words and in JSON.

#include <string>

#include "planner/planner.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// A table with a line for each step: displacement, speeds, outcomes with envelopes, successors.
[[nodiscard]] std::string step_table(const Plan& plan);

/// A dozen lines for people about a plan that was found.
[[nodiscard]] std::string summary(const PlanReport& report, const Task& task,
                                  const std::string& file);

/// Keys are documented in planner/README.md.
[[nodiscard]] std::string statistics_json(const PlanReport& report);

}  // namespace tenon::planner
