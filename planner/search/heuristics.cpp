#include "planner/search/heuristics.h"

#include <algorithm>
#include <cmath>

namespace tenon::planner {
namespace {

double step_along(const Task& task, int axis) { return axis < 3 ? task.step_m : task.step_rad; }

/// Steps along one axis; a contact takes at least one. A guide suggests the whole way as one move.
double steps_along(const Task& task, int axis, double way) {
  if (task.guide_moves) return 1.0;
  constexpr double kRounding = 1e-6;
  return std::max(1.0, std::ceil(way / step_along(task, axis) - kRounding));
}

/// Moves `at` beside the place where a push begins, and pays for it. Half a step off is there.
double cost_of_via(const ContactAttractor& contact, const Task& task, Pose& at,
                   double uncertainty_m2) {
  Vector6 aside = displacement_between(at, *contact.via);
  double steps = 0.0;
  for (int axis = 0; axis < 6; ++axis) {
    const double near = 0.5 * step_along(task, axis);
    if (axis == contact.axis || std::abs(aside[axis]) <= near) {
      aside[axis] = 0.0;
    } else {
      aside[axis] -= std::copysign(near, aside[axis]);
      steps += task.guide_moves ? 1.0 : std::abs(aside[axis]) / step_along(task, axis);
    }
  }
  const Pose from = at;
  at = displaced(at, aside);
  return task.distance_weight_per_m * distance(from, at, metric_of(task)) +
         move_cost(task, uncertainty_m2) * steps;
}

double cost_of_contacts(const BeliefSummary& belief, const Guide& guide, const Task& task, Pose& at,
                        double& uncertainty_m2) {
  double cost = 0.0;
  for (const ContactAttractor& contact : guide.contacts) {
    const int axis = contact.axis;
    if (is_behind(belief, contact, task)) continue;
    if (contact.via) cost += cost_of_via(contact, task, at, uncertainty_m2);
    Vector6 along = Vector6::Zero();
    along[axis] = displacement_between(at, contact.mean)[axis];
    const Pose touching = displaced(at, along);
    const double steps = steps_along(task, axis, std::abs(along[axis]) + belief.spread[axis]);
    cost += task.distance_weight_per_m * distance(at, touching, metric_of(task)) +
            move_cost(task, uncertainty_m2) * steps;
    at = touching;
    uncertainty_m2 = std::min(uncertainty_m2, contact.uncertainty_m2);
  }
  return cost;
}

/// How far it is to where the goal's axes of their own are satisfied and the others are at it.
/// Taken axis by axis, rotation vectors are no metric: where one of them differs, no rotation
/// counts.
double beyond_own_m(const Pose& from, const Task& task) {
  const GoalAxes& axes = task.goal_axes;
  if (!axes.any()) return distance(from, task.goal, metric_of(task));
  Vector6 off = beyond_own(displacement_between(task.goal, from), axes);
  const bool turned_together = axes.together(3) && axes.together(4) && axes.together(5);
  if (!turned_together) off.tail<3>().setZero();
  return off.head<3>().norm() + task.orientation_weight * off.tail<3>().norm();
}

}  // namespace

double anchor_heuristic(const BeliefSummary& belief, const Task& task) {
  if (at_goal(belief, task)) return 0.0;
  const double away_m = beyond_own_m(belief.mean, task) - task.goal_tolerance_m;
  return task.distance_weight_per_m * std::max(0.0, away_m) +
         move_cost(task, belief.uncertainty_m2);
}

bool is_behind(const BeliefSummary& belief, const ContactAttractor& contact, const Task& task) {
  const double together = std::sqrt(task.goal_uncertainty_m2);
  return belief.spread[contact.axis] <= contact.spread + together;
}

double foliated_heuristic(const BeliefSummary& belief, const Guide& guide, const Task& task) {
  Pose at = belief.mean;
  double uncertainty_m2 = belief.uncertainty_m2;
  double cost = guide.contact_scale * cost_of_contacts(belief, guide, task, at, uncertainty_m2);
  for (const Pose& next : guide.goals) {
    const double way_m = displacement_between(at, next).head<3>().lpNorm<1>();
    const double steps = task.guide_moves ? 1.0 : std::max(1.0, way_m / task.step_m);
    cost += task.distance_weight_per_m * distance(at, next, metric_of(task)) +
            move_cost(task, uncertainty_m2) * steps;
    at = next;
  }
  return cost;
}

}  // namespace tenon::planner
