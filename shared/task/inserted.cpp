#include "shared/task/inserted.h"

namespace tenon {

bool inserted(const Task& task, const Pose& tool) {
  if (!task.inserted) return true;
  const Vector3 tip_m = compose(inverse(task.inserted->pose), tool).position_m;
  return (tip_m.cwiseAbs().array() <= 0.5 * task.inserted->size_m.array()).all();
}

bool within_tolerance(const Task& task, const Pose& tool) {
  Vector6 off = displacement_between(task.goal, tool);
  for (int axis = 3; axis < 6; ++axis) {
    if (!has(task.coordinates, axis)) off[axis] = 0.0;
  }
  return off.head<3>().norm() + task.orientation_weight * off.tail<3>().norm() <=
         task.goal_tolerance_m;
}

}  // namespace tenon
