#include "shared/task/inserted.h"

namespace tenon {

bool inserted(const Task& task, const Pose& tool) {
  if (!task.inserted) return true;
  const Vector3 tip_m = compose(inverse(task.inserted->pose), tool).position_m;
  return (tip_m.cwiseAbs().array() <= 0.5 * task.inserted->size_m.array()).all();
}

double tolerances_from_goal(const Task& task, const Pose& tool) {
  Vector6 off = displacement_between(task.goal, tool);
  for (int axis = 3; axis < 6; ++axis) {
    if (!has(task.coordinates, axis)) off[axis] = 0.0;
  }
  return tolerances_off(off, task.goal_tolerance_m, task.goal_axes, task.orientation_weight);
}

bool within_tolerance(const Task& task, const Pose& tool) {
  return tolerances_from_goal(task, tool) <= 1.0;
}

}  // namespace tenon
