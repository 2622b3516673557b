#include "planner/judge/plan_draft.h"

#include <string>

#include "shared/base/error.h"
#include "shared/plan/codec.h"

namespace tenon::planner {
namespace {

Successor next_step(std::size_t step, std::size_t steps) {
  return step + 1 == steps ? kSuccessorDone : static_cast<Successor>(step + 1);
}

}  // namespace

Plan through_bytes(const Plan& plan) {
  DecodedPlan decoded = decode_plan(encode_plan(plan));
  if (!decoded.plan) {
    throw InputError("plan: its own bytes are refused at " + decoded.field + ": " +
                     to_string(decoded.error));
  }
  return std::move(*decoded.plan);
}

Plan draft_plan(const Task& task, const Start& start, const CellAssumptions& assumptions,
                std::span<const Vector6> displacements, std::span<const std::size_t> plain) {
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
  plan.goal_axes = task.goal_axes;
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
  for (const std::size_t step : plain) make_plain(plan, step);
  return through_bytes(plan);
}

void make_plain(Plan& plan, std::size_t step) {
  if (plan.parameter_sets.size() == 1) {
    plan.parameter_sets.push_back(plan.parameter_sets.front());
    plan.parameter_sets.back().aligns = false;
  }
  plan.steps[step].parameter_set = 1;
}

}  // namespace tenon::planner
