#pragma once
// From a task and a path to a plan, through the bytes that a file would hold.

#include <cstdint>
#include <span>
#include <vector>

#include "planner/chain.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// What the plan assumes of the cell that will execute it.
struct CellAssumptions {
  double contact_stiffness_Npm = 5e4;
  double latency_max_s = 0.010;  ///< (n + 1/2) T + tau_arm
};

/// A plan whose steps have these displacements and contact speed throughout, in which every outcome
/// but a timeout leads on and no envelope is checked yet. As it comes back from its own bytes:
/// every value is one that the file holds.
/// @throws InputError where there are more than kMaxSteps steps
[[nodiscard]] Plan draft_plan(const Task& task, const Start& start,
                              const CellAssumptions& assumptions,
                              std::span<const Vector6> displacements);

/// Everything of the search's moves but their displacement: that of a plan's step, as the file has
/// it.
[[nodiscard]] MoveParameters search_move(const Task& task, const Start& start,
                                         const CellAssumptions& assumptions);

/// Likewise of the long moves that only look for attractors: as fast as the task allows, with the
/// time that they need. @param move what search_move() says
[[nodiscard]] MoveParameters long_move(const Task& task, MoveParameters move);

/// The plan that its bytes say.
/// @throws InputError where it cannot be represented
[[nodiscard]] Plan through_bytes(const Plan& plan);

/// The command is down to contact speed this far before the nearest contact that was seen.
inline constexpr double kSlowMargin_m = 0.030;

/// How far each step may go at approach speed: up to a margin before the nearest contact that any
/// of the chains made, all the way where none made one. Contacts of all sorts count, releases too.
/// @param particle_sigmas how many standard deviations out the chains start; infinite: keep nothing
/// in hand for starts beyond them
[[nodiscard]] std::vector<double> slow_from(const Plan& plan, std::span<const Chain> chains,
                                            double particle_sigmas);

}  // namespace tenon::planner
