#include "shared/plan/plan.h"

namespace tenon {

const char* to_string(PlanMethod method) {
  switch (method) {
    case PlanMethod::kMha:
      return "mha";
    case PlanMethod::kSingleParticle:
      return "single-particle";
    case PlanMethod::kContactGreedy:
      return "contact-greedy";
  }
  return "?";
}

MoveParameters move_parameters(const Plan& plan, std::size_t step) {
  const Step& s = plan.steps[step];
  const ParameterSet& set = plan.parameter_sets[s.parameter_set];
  MoveParameters move;
  move.displacement = s.displacement;
  move.slow_from_m = s.slow_from_m;
  move.speeds = set.speeds;
  move.thresholds = set.thresholds;
  move.compliance = plan.compliance;
  move.force_limit_N = plan.force_limit_N;
  move.torque_limit_Nm = plan.torque_limit_Nm;
  move.timeout_us = set.timeout_us;
  move.trigger_mask = set.trigger_mask;
  move.sensed_axes = set.sensed_axes;
  move.aligns = set.aligns;
  if (set.carried_axes) move.carried_from = plan.goal.orientation;
  return move;
}

}  // namespace tenon
