#include "planner/plan_builder.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "planner/primitives.h"
#include "shared/base/error.h"
#include "shared/plan/codec.h"

namespace tenon::planner {
namespace {

// A run at approach speed shorter than this is not worth a second speed.
constexpr double kShortestFast_m = 0.020;

Successor next_step(std::size_t step, std::size_t steps) {
  return step + 1 == steps ? kSuccessorDone : static_cast<Successor>(step + 1);
}

}  // namespace

MoveParameters search_move(const Task& task, const Start& start,
                           const CellAssumptions& assumptions) {
  const std::array<Vector6, 1> displacement = {step_primitives(task).front().displacement};
  return move_parameters(draft_plan(task, start, assumptions, displacement), 0);
}

MoveParameters long_move(const Task& task, MoveParameters move) {
  move.slow_from_m = task.long_step_m;
  constexpr double kLongest_s = 4000.0;
  const double time_s = 2.0 + 1.5 * task.long_step_m / move.speeds.approach_mps;
  move.timeout_us = static_cast<std::uint32_t>(1e6 * std::min(time_s, kLongest_s));
  return move;
}

Plan through_bytes(const Plan& plan) {
  DecodedPlan decoded = decode_plan(encode_plan(plan));
  if (!decoded.plan) {
    throw InputError("plan: its own bytes are refused at " + decoded.field + ": " +
                     to_string(decoded.error));
  }
  return std::move(*decoded.plan);
}

Plan draft_plan(const Task& task, const Start& start, const CellAssumptions& assumptions,
                std::span<const Vector6> displacements) {
  if (displacements.size() > kMaxSteps) {
    throw InputError("plan: " + std::to_string(displacements.size()) + " steps, a plan holds " +
                     std::to_string(kMaxSteps));
  }
  Plan plan;
  plan.task_name = task.name;
  plan.start_name = start.name;
  plan.task_hash = task.hash;
  plan.coordinates = task.coordinates;
  plan.start = start.pose;
  plan.goal = task.goal;
  plan.goal_tolerance_m = task.goal_tolerance_m;
  plan.compliance = task.compliance;
  plan.force_limit_N = task.force_limit_N;
  plan.torque_limit_Nm = task.torque_limit_Nm;
  plan.contact_stiffness_Npm = assumptions.contact_stiffness_Npm;
  plan.latency_max_s = assumptions.latency_max_s;
  plan.check_envelopes = false;
  plan.parameter_sets = {task.motion};
  for (std::size_t i = 0; i < displacements.size(); ++i) {
    Step step;
    step.displacement = displacements[i];
    for (const Outcome outcome : kOutcomes) {
      if (outcome == Outcome::kTimeout) continue;
      step.outcomes[static_cast<std::size_t>(outcome)].successor =
          next_step(i, displacements.size());
    }
    plan.steps.push_back(step);
  }
  return through_bytes(plan);
}

std::vector<double> slow_from(const Plan& plan, std::span<const Chain> chains,
                              double particle_sigmas) {
  std::vector<double> distances;
  for (std::size_t step = 0; step < plan.steps.size(); ++step) {
    const Vector3 way = plan.steps[step].displacement.head<3>();
    const double length_m = way.norm();
    double nearest_m = std::numeric_limits<double>::infinity();
    double farthest_m = 0.0;
    bool in_contact = false;
    for (const Chain& chain : chains) {
      for (std::size_t i = 0; i < chain.moves.size(); ++i) {
        if (chain.steps[i] != step || length_m == 0.0) continue;
        const double along_m = chain.moves[i].travelled.head<3>().dot(way) / length_m;
        farthest_m = std::max(farthest_m, along_m);
        if (chain.moves[i].outcome == Outcome::kReached) continue;
        in_contact = true;
        nearest_m = std::min(nearest_m, along_m);
      }
    }
    // The chains start c_p standard deviations out; keep one more in hand.
    const double spread_m = in_contact ? (farthest_m - nearest_m) / (2.0 * particle_sigmas) : 0.0;
    const double fast_m = in_contact ? nearest_m - spread_m - kSlowMargin_m : length_m;
    distances.push_back(fast_m < kShortestFast_m ? 0.0 : std::min(fast_m, length_m));
  }
  return distances;
}

}  // namespace tenon::planner
