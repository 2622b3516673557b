#pragma once
// A plan file as people and programs want to see it.

#include <cstddef>
#include <string>

#include "shared/plan/plan.h"

namespace tenon::planner {

/// Header and sizes; step_table() in summary.h has the steps.
[[nodiscard]] std::string header_text(const Plan& plan, std::size_t bytes);

/// Everything that the file holds. Keys are documented in planner/README.md.
[[nodiscard]] std::string plan_json(const Plan& plan, std::size_t bytes);

}  // namespace tenon::planner
