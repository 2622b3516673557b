#include "executor/dry_run/plan_reach.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace tenon::executor {
namespace {

void begin_from(std::optional<StepReach>& step, const StepReach::End& end) {
  if (step) {
    step->begin.include(end.box);
  } else {
    step.emplace();
    step->begin = end.box;
  }
  step->before.bits |= end.contacts.bits;
}

/// A travel along axes that are turned by up to so much (rad, about each), as the task frame has
/// it.
ReachBox as_turned(const ReachBox& travel, const Vector3& turned_rad) {
  ReachBox box = travel;
  const Vector6 most = travel.low.cwiseAbs().cwiseMax(travel.high.cwiseAbs());
  for (int about = 0; about < 3; ++about) {
    const double sine = std::sin(std::min(turned_rad[about], 0.5 * std::numbers::pi));
    const double shortening = 1.0 - std::cos(turned_rad[about]);
    for (const int first : {0, 3}) {
      const int u = first + (about + 1) % 3;
      const int v = first + (about + 2) % 3;
      for (const auto& [axis, across] : {std::pair(u, v), std::pair(v, u)}) {
        const double beside = sine * most[across] + shortening * most[axis];
        box.low[axis] -= beside;
        box.high[axis] += beside;
      }
    }
  }
  return box;
}

/// How far the axes of a step may be turned, about each axis of the task frame.
Vector3 turned_rad(const Plan& plan, const Step& step, const ReachBox& begin) {
  if (!plan.parameter_sets[step.parameter_set].carried_axes) return Vector3::Zero();
  const Vector3 from_goal = displacement_between(plan.goal, plan.start).tail<3>();
  return (begin.low.tail<3>() + from_goal)
      .cwiseAbs()
      .cwiseMax((begin.high.tail<3>() + from_goal).cwiseAbs());
}

}  // namespace

StepReach reach_from(const ReachBox& begin, ContactSignature before, const Plan& plan,
                     const Step& step) {
  StepReach reach;
  reach.begin = begin;
  reach.before = before;
  reach.swept = begin;
  for (const OutcomeRule& rule : step.outcomes) {
    if (rule.successor == kSuccessorFail) continue;
    const Envelope& seen = rule.envelope;
    StepReach::End end{rule.successor, {}, {}};
    end.contacts = plan.check_envelopes ? seen.possible : kAllContacts;
    if (plan.check_places) {
      end.box = {seen.place_min, seen.place_max};
      reach.swept.include(end.box);
      reach.ends.push_back(end);
      continue;
    }
    ReachBox travel{seen.travelled_min, seen.travelled_max};
    if (!plan.check_envelopes) {
      travel = {step.displacement.cwiseMin(0.0), step.displacement.cwiseMax(0.0)};
    }
    travel = as_turned(travel, turned_rad(plan, step, begin));
    end.box = begin.moved(travel.low, travel.high);
    reach.swept.include(end.box);
    reach.ends.push_back(end);
  }
  return reach;
}

// Successors only grow, so one pass meets every step after all of its predecessors.
std::vector<std::optional<StepReach>> reach_of(const Plan& plan) {
  std::vector<std::optional<StepReach>> reach(plan.steps.size());
  if (!reach.empty()) reach[0].emplace();
  for (std::size_t i = 0; i < reach.size(); ++i) {
    if (!reach[i]) continue;
    reach[i] = reach_from(reach[i]->begin, reach[i]->before, plan, plan.steps[i]);
    for (const StepReach::End& end : reach[i]->ends) {
      if (end.successor < reach.size()) begin_from(reach[end.successor], end);
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
    if (has(plan.goal_axes.free, axis)) continue;
    // Beside its coordinates the plan goes nowhere; a file's floats turn by a little.
    constexpr double kTurnedLeast_rad = 1e-3;
    const bool searched = has(plan.coordinates, axis);
    const double turned_rad = searched ? slack_rad : std::max(slack_rad, kTurnedLeast_rad);
    const double own = plan.goal_axes.tolerance[axis];
    const double goal_m = own > 0.0 ? own : plan.goal_tolerance_m;
    const double slack = axis < 3 ? slack_m + goal_m : turned_rad + own;
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
