#include "planner/belief/primitives.h"

namespace tenon::planner {
namespace {

// Shorter direct moves change nothing that anybody could measure.
constexpr double kNoMove = 1e-4;

std::vector<Primitive> both_ways(const Task& task, double step_m, double step_rad) {
  std::vector<Primitive> primitives;
  for (int axis = 0; axis < 6; ++axis) {
    const double step = axis < 3 ? step_m : step_rad;
    if (!has(moved_axes(task), axis) || step == 0.0) continue;
    for (const int sign : {+1, -1}) {
      Primitive primitive;
      primitive.label = 2 * axis + (sign > 0 ? 0 : 1);
      primitive.displacement[axis] = sign * step;
      primitive.displacement = stored(primitive.displacement);
      primitives.push_back(primitive);
    }
  }
  return primitives;
}

}  // namespace

Vector6 stored(const Vector6& value) { return value.cast<float>().cast<double>(); }

CoordinateMask moved_axes(const Task& task) {
  return static_cast<CoordinateMask>(task.coordinates & task.compliance.compliant_axes);
}

std::vector<Primitive> step_primitives(const Task& task) {
  return both_ways(task, task.step_m, task.step_rad);
}

std::vector<Primitive> long_primitives(const Task& task) {
  return both_ways(task, task.long_step_m, 0.0);
}

Vector6 in_move_axes(const Task& task, const Pose& tool, const Vector6& displacement) {
  if (!task.motion.carried_axes) return displacement;
  const Eigen::Quaterniond back = task.goal.orientation * tool.orientation.conjugate();
  Vector6 own;
  own << back * displacement.head<3>(), back * displacement.tail<3>();
  return own;
}

std::optional<Primitive> direct_primitive(const Task& task, const Pose& mean, const Pose& place,
                                          int label) {
  Vector6 displacement = in_move_axes(task, mean, displacement_between(mean, place));
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(moved_axes(task), axis)) displacement[axis] = 0.0;
  }
  if (displacement.head<3>().norm() > task.direct_reach_m) return std::nullopt;
  if (displacement.cwiseAbs().maxCoeff() < kNoMove) return std::nullopt;
  return Primitive{label, stored(displacement)};
}

}  // namespace tenon::planner
