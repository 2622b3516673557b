#pragma once
// The data of a plan's page; shared/drawing/page/README.md has its keys. Pure; any thread.

#include <string>

#include "planner/report/report_data.h"

namespace tenon::planner {

/// One JSON object.
[[nodiscard]] std::string page_json(const ReportData& data);

}  // namespace tenon::planner
