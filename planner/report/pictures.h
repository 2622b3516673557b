#pragma once
// The page's pictures that do not move, for print and where no script runs: a whole plan from one
// side, and the belief's uncertainty over the steps. Inline SVG; pure; any thread.

#include <string>
#include <vector>

#include "planner/report/report_canvas.h"
#include "planner/report/report_data.h"

namespace tenon::planner {

/// The environment: filled where the plane through the goal cuts it, in outline what stands
/// elsewhere.
[[nodiscard]] std::string surroundings(const Task& task, const Canvas& canvas,
                                       const drawing::View& view);

/// The held part with its tool at a pose. @param style SVG attributes
[[nodiscard]] std::string part_at(const Task& task, const Canvas& canvas, const Pose& pose,
                                  const char* style);

/// The part where it belongs, as every picture shows it.
[[nodiscard]] std::string part_at_goal(const Task& task, const Canvas& canvas, const Pose& goal);

/// The environment, the part at start and goal, and the paths of all particles and draws.
[[nodiscard]] std::string overview(const ReportData& data, const drawing::View& view);

/// The environment, the part at the goal and where a run ended, its way and the particles' paths.
/// @param tools of the run, as they are drawn; not empty
[[nodiscard]] std::string run_overview(const ReportData& data, const std::vector<Pose>& tools,
                                       const drawing::View& view);

/// A bar a node, and what it shows in words.
[[nodiscard]] std::string uncertainty_chart(const ReportData& data);

}  // namespace tenon::planner
