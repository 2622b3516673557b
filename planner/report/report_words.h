#pragma once
// The page's words: names, amounts and outcomes, as plain text but for the names. Pure; any thread.

#include <cstddef>
#include <set>
#include <string>

#include "planner/report/report_data.h"

namespace tenon::planner {

/// A direction counts as settled once its spread is below this part of what it was.
inline constexpr double kCollapsed = 0.2;

/// "wall, table", escaped.
[[nodiscard]] std::string names_of(const std::set<std::string>& names);

/// "1.2 mm" or degrees, of m or rad; with two digits more where little is left, without any where
/// that would be all zeros.
[[nodiscard]] std::string amount(double value, int axis);

/// The contacts that every run had, and those that only some had: "+z, possible -x".
[[nodiscard]] std::string contacts_text(const Envelope& envelope);

/// The coordinates of the plan, each with an amount.
[[nodiscard]] std::string spread_text(const Plan& plan, const Vector6& spread);

/// How many particles had which outcome in the step: "3 contact, 1 reached".
[[nodiscard]] std::string outcomes_text(const ReportData& data, std::size_t step);

}  // namespace tenon::planner
