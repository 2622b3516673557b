#include "planner/belief/belief_summary.h"

#include <algorithm>

#include "shared/task/inserted.h"

namespace tenon::planner {
namespace {

// What an arm adds to a plan's own errors needs as much room again: a plan that ends at the rim of
// the tolerance is done, and wrong now and then.
constexpr double kOfTolerance = 0.5;

/// Rotations that are no coordinate are as at the goal: no move changes them, and the goal does not
/// ask for them.
Pose as_turned_at_goal(const Pose& tool, const Task& task) {
  Vector6 off = displacement_between(task.goal, tool);
  bool other = false;
  for (int axis = 3; axis < 6; ++axis) {
    if (has(task.coordinates, axis) || off[axis] == 0.0) continue;
    off[axis] = 0.0;
    other = true;
  }
  return other ? Pose{tool.position_m, displaced(task.goal, off).orientation} : tool;
}

}  // namespace

BeliefSummary summarise(const Belief& belief, const Task& task) {
  const Metric metric = metric_of(task);
  const Pose mean = mean_pose(belief);
  BeliefSummary summary{as_turned_at_goal(mean, task), uncertainty(belief, metric)};
  for (const Particle& particle : belief.particles) {
    const Pose tool = particle.tool();
    const Vector6 off = displacement_between(mean, tool);
    summary.spread = summary.spread.cwiseMax(off.cwiseAbs());
    summary.farthest_m = std::max(summary.farthest_m, distance(tool, task.goal, metric));
    summary.farthest = std::max(summary.farthest, tolerances_from_goal(task, tool));
    summary.inserted = summary.inserted && inserted(task, tool);
  }
  return summary;
}

double move_cost(const Task& task, double uncertainty_m2) {
  return task.move_weight + task.uncertainty_weight_per_m2 * uncertainty_m2;
}

double edge_cost(const BeliefSummary& from, const BeliefSummary& to, const Task& task) {
  return task.distance_weight_per_m * distance(from.mean, to.mean, metric_of(task)) +
         move_cost(task, from.uncertainty_m2);
}

bool at_goal(const BeliefSummary& belief, const Task& task) {
  return belief.farthest <= kOfTolerance &&
         tolerances_from_goal(task, belief.mean) <= kOfTolerance &&
         belief.uncertainty_m2 <= task.goal_uncertainty_m2 && belief.inserted;
}

}  // namespace tenon::planner
