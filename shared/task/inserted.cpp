#include "shared/task/inserted.h"

namespace tenon {

bool inserted(const Task& task, const Pose& tool) {
  if (!task.inserted) return true;
  const Vector3 tip_m = compose(inverse(task.inserted->pose), tool).position_m;
  return (tip_m.cwiseAbs().array() <= 0.5 * task.inserted->size_m.array()).all();
}

}  // namespace tenon
