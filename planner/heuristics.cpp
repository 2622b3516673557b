#include "planner/heuristics.h"

#include <algorithm>

namespace tenon::planner {

BeliefSummary summarise(const Belief& belief, const Task& task) {
  const Metric metric = metric_of(task);
  BeliefSummary summary{mean_pose(belief), uncertainty(belief, metric), 0.0};
  for (const Particle& particle : belief.particles) {
    summary.farthest_m = std::max(summary.farthest_m, distance(particle.pose, task.goal, metric));
  }
  return summary;
}

double edge_cost(const BeliefSummary& from, const BeliefSummary& to, const Task& task) {
  return task.distance_weight_per_m * distance(from.mean, to.mean, metric_of(task)) +
         task.uncertainty_weight_per_m2 * from.uncertainty_m2;
}

bool at_goal(const BeliefSummary& belief, const Task& task) {
  return belief.farthest_m <= task.goal_tolerance_m &&
         distance(belief.mean, task.goal, metric_of(task)) <= task.goal_tolerance_m &&
         belief.uncertainty_m2 <= task.goal_uncertainty_m2;
}

double anchor_heuristic(const BeliefSummary& belief, const Task& task) {
  if (at_goal(belief, task)) return 0.0;
  const double away_m = distance(belief.mean, task.goal, metric_of(task)) - task.goal_tolerance_m;
  return task.distance_weight_per_m * std::max(0.0, away_m) +
         task.uncertainty_weight_per_m2 * belief.uncertainty_m2;
}

double foliated_heuristic(const BeliefSummary& belief, const Attractor& attractor,
                          const Task& task) {
  const bool uncertain = belief.uncertainty_m2 > task.goal_uncertainty_m2;
  const Pose& towards = uncertain ? attractor.contact : attractor.goal;
  return task.distance_weight_per_m * distance(belief.mean, towards, metric_of(task)) +
         task.uncertainty_weight_per_m2 * belief.uncertainty_m2;
}

}  // namespace tenon::planner
