#include "planner/goal_certainty.h"

#include <algorithm>
#include <cmath>

namespace tenon::planner {
namespace {

// What no encoder tells apart.
constexpr double kFinest_m = 10e-6;

/// How far the part can go from the goal without touching, of the axis's tolerance.
double free_part(const Task& task, const Vector6& tolerance, double finest, Rollout& rollout) {
  const auto collides = [&](double part) {
    return rollout.in_collision(displaced(task.goal, part * tolerance));
  };
  if (!collides(1.0)) return 1.0;
  double free = 0.0;
  double blocked = 1.0;
  while (blocked - free > finest) {
    const double middle = 0.5 * (free + blocked);
    (collides(middle) ? blocked : free) = middle;
  }
  return free;
}

}  // namespace

Task with_goal_certainty(Task task, Rollout& rollout) {
  if (task.goal_uncertainty_m2 > 0.0) return task;
  double room_m = task.goal_tolerance_m;
  int coordinates = 0;
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(task.coordinates, axis) || has(task.goal_axes.free, axis)) continue;
    ++coordinates;
    // Of an axis of its own, as much of the one tolerance as it is of its.
    const double own = task.goal_axes.tolerance[axis];
    if (axis >= 3 && own == 0.0) continue;
    const Vector6 way = (own > 0.0 ? own : task.goal_tolerance_m) * Vector6::Unit(axis);
    const double finest = kFinest_m / (axis < 3 ? way.norm() : task.goal_tolerance_m);
    const double both =
        free_part(task, way, finest, rollout) + free_part(task, -way, finest, rollout);
    room_m = std::min(room_m, 0.5 * both * task.goal_tolerance_m);
  }
  const double deviation_m = std::max(kFinest_m, 0.5 * room_m);
  task.goal_uncertainty_m2 = coordinates * deviation_m * deviation_m;
  return task;
}

}  // namespace tenon::planner
