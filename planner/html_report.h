#pragma once
// A plan on one page: seen from above, its uncertainty step by step, and every step in words.

#include <string>

#include "planner/certification.h"
#include "planner/validation.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// One self-contained HTML document with inline SVG.
/// @param certification of this plan; its first run gives the particles' paths
/// @param validation a few draws, drawn faintly
[[nodiscard]] std::string html_report(const Plan& plan, const Task& task,
                                      const Certification& certification,
                                      const Validation& validation);

}  // namespace tenon::planner
