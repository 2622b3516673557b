#include "executor/dry_run/plan_reach.h"

#include <algorithm>
#include <cmath>

namespace tenon::executor {
namespace {

void begin_from(std::optional<StepReach>& step, const StepReach::End& end,
                ContactSignature contacts) {
  if (step) {
    step->begin.include(end.box);
  } else {
    step.emplace();
    step->begin = end.box;
  }
  step->before.bits |= contacts.bits;
}

}  // namespace

// Successors only grow, so one pass meets every step after all of its predecessors.
std::vector<std::optional<StepReach>> reach_of(const Plan& plan) {
  std::vector<std::optional<StepReach>> reach(plan.steps.size());
  if (!reach.empty()) reach[0].emplace();
  for (std::size_t i = 0; i < reach.size(); ++i) {
    if (!reach[i]) continue;
    StepReach& here = *reach[i];
    const Step& step = plan.steps[i];
    here.swept = here.begin;
    for (const OutcomeRule& rule : step.outcomes) {
      if (rule.successor == kSuccessorFail) continue;
      const Envelope& seen = rule.envelope;
      StepReach::End end{rule.successor, {}};
      end.box = plan.check_envelopes ? here.begin.moved(seen.travelled_min, seen.travelled_max)
                                     : here.begin.moved(step.displacement.cwiseMin(0.0),
                                                        step.displacement.cwiseMax(0.0));
      here.swept.include(end.box);
      if (rule.successor < reach.size()) {
        begin_from(reach[rule.successor], end, plan.check_envelopes ? seen.possible : kAllContacts);
      }
      here.ends.push_back(end);
    }
  }
  return reach;
}

std::optional<ReachBox> done_reach(const Plan& plan) {
  std::optional<ReachBox> done;
  for (const auto& step : reach_of(plan)) {
    if (!step) continue;
    for (const StepReach::End& end : step->ends) {
      if (end.successor != kSuccessorDone) continue;
      if (!done) done = end.box;
      done->include(end.box);
    }
  }
  return done;
}

std::optional<GoalGap> goal_gap(const Plan& plan, const ReachBox& reach, const Pose& tool,
                                double slack_m, double slack_rad) {
  if (plan.goal_tolerance_m <= 0.0) return std::nullopt;
  const Vector6 goal = displacement_between(plan.start, plan.goal);
  const Vector6 end = displacement_between(plan.start, tool);
  std::optional<GoalGap> worst;
  double worst_excess = 0.0;
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(plan.coordinates, axis)) continue;
    const double slack = axis < 3 ? slack_m + plan.goal_tolerance_m : slack_rad;
    const auto beyond = [&](double at) {
      return std::max(reach.low[axis] - slack - at, at - reach.high[axis] - slack);
    };
    const double excess = std::max(beyond(goal[axis]), beyond(end[axis]));
    if (excess <= worst_excess) continue;
    worst_excess = excess;
    const double from = axis < 3 ? plan.start.position_m[axis] : 0.0;
    worst = {axis, from + end[axis], from + goal[axis],
             reach.high[axis] - reach.low[axis] + 2.0 * slack};
  }
  return worst;
}

}  // namespace tenon::executor
