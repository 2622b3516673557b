#pragma once
// A run laid over its plan, on one page: how it ended, what it felt and how it moved over time,
// step by step beside what the plan expects, and its way over the plan's.

#include <string>

#include "planner/report/report_data.h"
#include "shared/plan/plan.h"
#include "shared/run/recorded_run.h"

namespace tenon::planner {

/// One self-contained HTML document. @param data of the plan; null: without part and environment
[[nodiscard]] std::string run_report(const Plan& plan, const RecordedRun& run,
                                     const ReportData* data);

}  // namespace tenon::planner
