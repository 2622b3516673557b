#pragma once
// A plan on one page: why it works, its paths seen from where they can be seen, its uncertainty
// step by step, and every step in a picture and in words.

#include <cstddef>
#include <string>

#include "planner/judge/certification.h"
#include "planner/judge/validation.h"
#include "planner/plan_report.h"
#include "planner/report/statistics.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// How many random starts the page shows.
inline constexpr std::size_t kReportDraws = 200;

/// One self-contained HTML document with inline SVG.
/// @param certification of this plan, made again; its first run gives the particles' paths
/// @param validation drawn faintly; of a baseline also the uncertainty, which it does not know
/// @param story how it was found; null: the page does not say
[[nodiscard]] std::string html_report(const Plan& plan, const Task& task,
                                      const Certification& certification,
                                      const Validation& validation,
                                      const SearchStory* story = nullptr);

/// The same of a plan as planning leaves it: nothing is simulated again. @param report with a plan
[[nodiscard]] std::string html_report(const PlanReport& report, const Task& task);

}  // namespace tenon::planner
