#pragma once
// From a path to a plan that is yet to be judged, through the bytes that a file would hold. Pure;
// any thread.

#include <cstddef>
#include <span>

#include "planner/cell_fit/cell_assumptions.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// A plan whose steps have these displacements and contact speed throughout, in which every outcome
/// but a timeout leads on and no envelope is checked yet. As it comes back from its own bytes:
/// every value is one that the file holds.
/// @param plain steps whose touches do not align
/// @throws InputError where there are more than kMaxSteps steps
[[nodiscard]] Plan draft_plan(const Task& task, const Start& start,
                              const CellAssumptions& assumptions,
                              std::span<const Vector6> displacements,
                              std::span<const std::size_t> plain = {});

/// From now on what a step of a draft touches is held as it is met (ParameterSet::aligns).
void make_plain(Plan& plan, std::size_t step);

/// The plan that its bytes say.
/// @throws InputError where it cannot be represented
[[nodiscard]] Plan through_bytes(const Plan& plan);

}  // namespace tenon::planner
