#pragma once
// What the page of a plan and that of its run both say of the plan, as HTML. Pure; any thread.

#include <string>

#include "planner/report/report_data.h"

namespace tenon::planner {

/// An item of a list of badges. @param text HTML
[[nodiscard]] std::string badge(bool good, const std::string& text);

/// Each direction, and the steps that settle it. Empty for a baseline.
[[nodiscard]] std::string reasons(const ReportData& data);

/// A section with a row an outcome that the plan goes on from.
[[nodiscard]] std::string moves_section(const ReportData& data);

/// The uncertainty over the steps, as it moves and as it stands still.
[[nodiscard]] std::string uncertainty_section(const ReportData& data);

}  // namespace tenon::planner
