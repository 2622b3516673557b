#pragma once
// The data of a run's page; shared/drawing/page/README.md has its keys. Pure; any thread.

#include <cstddef>
#include <string>

#include "planner/report/report_data.h"
#include "shared/plan/plan.h"
#include "shared/run/recorded_run.h"

namespace tenon::planner {

/// Of a long run: two for each column of pixels that a wide screen has for a plot.
inline constexpr std::size_t kMomentsMax = 2400;

/// One JSON object. @param data of the plan; null: what it is executed on is not known
[[nodiscard]] std::string run_json(const Plan& plan, const RecordedRun& run,
                                   const ReportData* data);

}  // namespace tenon::planner
