#include "shared/task/touched.h"

#include "shared/task/ring.h"

namespace tenon {

bool is_floor(const Shape& shape, const Pose& goal) {
  return shape.pose.position_m.z() + 0.5 * shape.size_m.z() <= goal.position_m.z() + kAboveFloor_m;
}

std::set<std::string> touched_pieces(const Task& task, const std::vector<std::string>& pairs) {
  std::set<std::string> names;
  for (const Shape& shape : task.environment) {
    if (is_floor(shape, task.goal) && !has(task.coordinates, 2)) continue;
    for (const std::string& pair : pairs) {
      if (pair.ends_with("-" + shape.name)) names.insert(piece_of(shape.name));
    }
  }
  return names;
}

}  // namespace tenon
