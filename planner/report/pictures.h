#pragma once
// The page's pictures that do not move, for print and where no script runs: a whole plan from one
// side, and the belief's uncertainty over the steps. Inline SVG; pure; any thread.

#include <string>

#include "planner/report/report_canvas.h"
#include "planner/report/report_data.h"

namespace tenon::planner {

/// The environment, the part at start and goal, and the paths of all particles and draws.
[[nodiscard]] std::string overview(const ReportData& data, const drawing::View& view);

/// A bar a node, and what it shows in words.
[[nodiscard]] std::string uncertainty_chart(const ReportData& data);

}  // namespace tenon::planner
