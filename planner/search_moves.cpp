#include "planner/search_moves.h"

#include <algorithm>
#include <array>

#include "planner/belief/primitives.h"
#include "planner/judge/envelopes.h"
#include "planner/judge/plan_draft.h"
#include "shared/task/spread.h"

namespace tenon::planner {

namespace {

Plan one_step(const Task& task, const Start& start, const CellAssumptions& assumptions) {
  const std::array<Vector6, 1> displacement = {step_primitives(task).front().displacement};
  return draft_plan(task, start, assumptions, displacement);
}

}  // namespace

CellAssumptions stored_assumptions(const Task& task, const std::optional<CellAssumptions>& told) {
  CellAssumptions assumptions;
  assumptions.contact_stiffness_Npm = task.contact_stiffness_Npm;
  if (told) assumptions = *told;
  const auto stored = [](double value) { return static_cast<double>(static_cast<float>(value)); };
  return {stored(assumptions.contact_stiffness_Npm), stored(assumptions.latency_max_s)};
}

MoveParameters search_move(const Task& task, const Start& start,
                           const CellAssumptions& assumptions) {
  return move_parameters(one_step(task, start, assumptions), 0);
}

std::int64_t search_step_us(const Task& task) {
  const bool turns = task.compliance.compliant_axes >> 3 != 0;
  return (turns ? 1 : 2) * task.rollout_step_us;
}

std::optional<MoveReach> reach_of_moves(const Task& task, const Start& start,
                                        const CellAssumptions& assumptions, const ArmReach& reach,
                                        std::string& why) {
  Plan draft = one_step(task, start, assumptions);
  draft.check_places = places_are_told(task.coordinates);
  const auto place = reach.start(draft, why);
  if (!place) {
    why = "the arm cannot hold start '" + start.name + "': " + why;
    return std::nullopt;
  }
  if (!place->elsewhere(task.goal, why)) {
    why = "the arm cannot hold the goal: " + why;
    return std::nullopt;
  }
  const EnvelopeMargins margins = envelope_margins(draft, task);
  MoveReach::Parameters parameters;
  parameters.start = start.pose;
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(task.coordinates, axis)) continue;
    parameters.margins[axis] = axis < 3 ? margins.position_m : margins.angle_rad;
  }
  parameters.draws_over_particles = std::max(1.0, drawn_sigmas(task) / task.particle_sigmas);
  return MoveReach(place, parameters);
}

MoveParameters long_move(const Task& task, MoveParameters move) {
  move.slow_from_m = task.long_step_m;
  constexpr double kLongest_s = 4000.0;
  const double time_s = 2.0 + 1.5 * task.long_step_m / move.speeds.approach_mps;
  move.timeout_us = static_cast<std::uint32_t>(1e6 * std::min(time_s, kLongest_s));
  return move;
}

}  // namespace tenon::planner
