#pragma once
// What the held part touches in the course of a plan, by name, of what it may bump into. Pure; any
// thread.

#include <cstddef>
#include <set>
#include <string>

#include "planner/report/report_data.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// A section seen from above is cut this far over the tip.
inline constexpr double kAboveFloor_m = 1e-3;

/// What the part stands on rather than bumps into.
[[nodiscard]] bool is_floor(const Shape& shape, const Plan& plan);

/// What some particle touches after the step.
[[nodiscard]] std::set<std::string> touched_after(const ReportData& data, std::size_t step);

/// What some particle touches after the step and did not before, or the other way round.
[[nodiscard]] std::set<std::string> found_or_lost(const ReportData& data, std::size_t step);

}  // namespace tenon::planner
