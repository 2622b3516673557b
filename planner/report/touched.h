#pragma once
// What the held part touches in the course of a plan, by name, of what it may bump into: the
// pieces of a ring or a mesh by the name of all. Pure; any thread.

#include <cstddef>
#include <set>
#include <string>

#include "planner/report/report_data.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// What some particle touches after the step.
[[nodiscard]] std::set<std::string> touched_after(const ReportData& data, std::size_t step);

/// What the particle of a chain touches after one of its moves.
[[nodiscard]] std::set<std::string> touched_by(const ReportData& data, const Chain& chain,
                                               std::size_t move);

/// What some particle touches after the step and did not before.
[[nodiscard]] std::set<std::string> begun_in(const ReportData& data, std::size_t step);
/// What some particle touched before the step and does not after it.
[[nodiscard]] std::set<std::string> ended_in(const ReportData& data, std::size_t step);

}  // namespace tenon::planner
