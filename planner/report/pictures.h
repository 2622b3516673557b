#pragma once
// The pictures of the page: a whole plan from one side, one step of it, and the belief's
// uncertainty over the steps. Inline SVG; pure; any thread.

#include <cstddef>
#include <string>

#include "planner/report/report_canvas.h"
#include "planner/report/report_data.h"

namespace tenon::planner {

/// The environment, the part at start and goal, and the paths of all particles and draws.
[[nodiscard]] std::string overview(const ReportData& data, const drawing::View& view);

/// What one step does to every particle, and what is touched after it.
[[nodiscard]] std::string step_picture(const ReportData& data, const drawing::View& view,
                                       std::size_t step);

/// A bar a node, and what it shows in words.
[[nodiscard]] std::string uncertainty_chart(const ReportData& data);

}  // namespace tenon::planner
