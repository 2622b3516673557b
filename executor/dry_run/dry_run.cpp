#include "executor/dry_run/dry_run.h"

#include <algorithm>

#include "executor/dry_run/movable_axes.h"
#include "executor/dry_run/slow_down.h"
#include "executor/dry_run/start_positions.h"
#include "shared/base/text.h"

namespace tenon::executor {
namespace {

// The plan walked through from one start position.
struct Walk {
  JointVector start{};
  std::vector<StepDemand> steps;
  std::string refusal;  ///< empty: all steps

  [[nodiscard]] double slowest() const {
    double slowest = 1.0;
    for (const StepDemand& step : steps) slowest = std::min(slowest, step.slow_down);
    return slowest;
  }
  [[nodiscard]] bool better_than(const Walk& other) const {
    if (refusal.empty() != other.refusal.empty()) return refusal.empty();
    return refusal.empty() ? slowest() > other.slowest() : steps.size() > other.steps.size();
  }
};

class Walker {
 public:
  Walker(const Plan& plan, const Cell& cell, const ToolKinematics& kinematics)
      : plan_(plan), cell_(cell), kinematics_(kinematics), reach_(reach_of(plan)) {}

  [[nodiscard]] Walk walk(const JointVector& start) const {
    Walk walk;
    walk.start = start;
    std::vector<std::optional<JointVector>> middle(plan_.steps.size());
    if (!middle.empty()) middle[0] = start;
    for (std::size_t i = 0; i < middle.size() && walk.refusal.empty(); ++i) {
      if (!middle[i]) continue;
      StepWalk step(plan_, i, *reach_[i], cell_, kinematics_);
      const auto refusal = step.run(*middle[i]);
      walk.steps.push_back(step.demand());
      walk.refusal = refusal ? *refusal : go_on(i, step, middle);
      if (!walk.refusal.empty()) {
        walk.refusal = format("step %d: ", static_cast<int>(i)) + walk.refusal;
      }
    }
    return walk;
  }

 private:
  // From where the step's outcomes end to where the steps after it begin.
  [[nodiscard]] std::string go_on(std::size_t i, const StepWalk& step,
                                  std::vector<std::optional<JointVector>>& middle) const {
    PathFollower follower(kinematics_, plan_.start);
    for (std::size_t outcome = 0; outcome < reach_[i]->ends.size(); ++outcome) {
      const StepReach::End& end = reach_[i]->ends[outcome];
      if (end.successor >= middle.size() || middle[end.successor]) continue;
      JointVector joints = step.end(outcome);
      if (!follower.follow(end.box.centre(), reach_[end.successor]->begin.centre(), joints,
                           [](const JointVector& /*joints*/) {})) {
        return format("no continuous way leads to step %d", static_cast<int>(end.successor));
      }
      middle[end.successor] = joints;
    }
    return {};
  }

  const Plan& plan_;
  const Cell& cell_;
  const ToolKinematics& kinematics_;
  std::vector<std::optional<StepReach>> reach_;
};

Plan slowed_as(const Plan& plan, const std::vector<StepDemand>& steps) {
  std::vector<double> factors(plan.steps.size(), 1.0);
  for (const StepDemand& step : steps) factors[step.step] = step.slow_down;
  return slowed(plan, factors);
}

}  // namespace

DryRun dry_run(const Plan& plan, const Cell& cell) {
  DryRun result;
  result.plan = plan;
  const ToolKinematics kinematics(cell);
  const StartPositions starts = start_positions(plan.start, cell, kinematics);
  if (starts.found.empty()) {
    result.refusals.push_back("start '" + plan.start_name + "': " + starts.refusal);
    return result;
  }
  result.start = starts.found.front();
  result.refusals = check_axes(plan, kinematics, *result.start);
  if (!result.refusals.empty()) return result;

  const Walker walker(plan, cell, kinematics);
  std::optional<Walk> best;
  for (const JointVector& start : starts.found) {
    Walk walk = walker.walk(start);
    if (!best || walk.better_than(*best)) best = std::move(walk);
    if (best->refusal.empty() && best->slowest() == 1.0) break;
  }
  result.start = best->start;
  result.steps = best->steps;
  if (best->refusal.empty()) {
    result.plan = slowed_as(plan, result.steps);
  } else {
    result.refusals.push_back(best->refusal);
  }
  return result;
}

}  // namespace tenon::executor
