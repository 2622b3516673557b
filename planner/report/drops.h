#pragma once
// Which step makes which direction more certain, and what does it. Pure; any thread.

#include <cstddef>
#include <string>
#include <vector>

#include "planner/report/report_data.h"

namespace tenon::planner {

/// A direction's uncertainty before and after a step that took a part of it.
struct Drop {
  std::size_t step = 0;
  int axis = 0;
  double before = 0.0;   ///< standard deviation, m or rad
  double after = 0.0;    ///< likewise
  bool settled = false;  ///< little is left of what it was before the step
  std::string why;       ///< "contact with wall begins"; plain text
};

/// What a step takes at least of what the direction began with counts as a drop.
inline constexpr double kDropWorthTelling = 0.05;

/// Of the step, by axis; none behind the steps that all chains ran.
[[nodiscard]] std::vector<Drop> drops_in(const ReportData& data, std::size_t step);

/// Of the whole plan, along one axis.
[[nodiscard]] std::vector<Drop> drops_along(const ReportData& data, int axis);

}  // namespace tenon::planner
