#include "planner/goal_certainty.h"

#include <algorithm>
#include <cmath>

namespace tenon::planner {
namespace {

// What no encoder tells apart.
constexpr double kFinest_m = 10e-6;

/// How far the part can go from the goal without touching, at most the axis's tolerance.
double free_way_m(const Task& task, const Vector6& way, double tolerance_m, Rollout& rollout) {
  const auto collides = [&](double far_m) {
    return rollout.in_collision(displaced(task.goal, far_m * way));
  };
  if (!collides(tolerance_m)) return tolerance_m;
  double free_m = 0.0;
  double blocked_m = tolerance_m;
  while (blocked_m - free_m > kFinest_m) {
    const double middle_m = 0.5 * (free_m + blocked_m);
    (collides(middle_m) ? blocked_m : free_m) = middle_m;
  }
  return free_m;
}

}  // namespace

Task with_goal_certainty(Task task, Rollout& rollout) {
  if (task.goal_uncertainty_m2 > 0.0) return task;
  double room_m = task.goal_tolerance_m;
  int coordinates = 0;
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(task.coordinates, axis) || has(task.goal_axes.free, axis)) continue;
    ++coordinates;
    if (axis >= 3) continue;
    // Of an axis of its own, as much of the one tolerance as it is of its.
    const double own_m = task.goal_axes.tolerance[axis];
    const double tolerance_m = own_m > 0.0 ? own_m : task.goal_tolerance_m;
    const Vector6 way = Vector6::Unit(axis);
    const double both_m =
        free_way_m(task, way, tolerance_m, rollout) + free_way_m(task, -way, tolerance_m, rollout);
    room_m = std::min(room_m, 0.5 * both_m * task.goal_tolerance_m / tolerance_m);
  }
  const double deviation_m = std::max(kFinest_m, 0.5 * room_m);
  task.goal_uncertainty_m2 = coordinates * deviation_m * deviation_m;
  return task;
}

}  // namespace tenon::planner
