#include "planner/search/goal_attractors.h"

#include <cmath>
#include <limits>
#include <optional>

#include "planner/belief/primitives.h"

namespace tenon::planner {
namespace {

/// Into a held contact or straight away from it.
bool pushes_along(const Primitive& primitive, ContactSignature signature) {
  for (int axis = 0; axis < 6; ++axis) {
    if (signature.sign(axis) != 0 && primitive.displacement[axis] != 0.0) return true;
  }
  return false;
}

/// Outside of the nearest place where a certain tool that is drawn straight out of the goal along
/// a contact loses it. The tool first presses against each side of the goal.
std::optional<Pose> mouth_of_goal(const Task& task, Particle certain, SuccessorEngine& succ) {
  const std::vector<Primitive> pushes = long_primitives(task);
  certain.pose = task.goal;
  certain.environment = {};
  std::optional<Pose> nearest;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const auto& pressed : succ.successors(Belief{{certain}}, pushes)) {
    if (!pressed || pressed->particles.front().signature.count() == 0) continue;
    const ContactSignature before = pressed->particles.front().signature;
    const auto ends = succ.successors(*pressed, pushes);
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (!ends[i] || pushes_along(pushes[i], before)) continue;
      const Particle& end = ends[i]->particles.front();
      if (end.signature.count() >= before.count()) continue;
      const int axis = axis_of(pushes[i]);
      Vector6 out = Vector6::Zero();
      out[axis] = displacement_between(task.goal, end.pose)[axis];
      out[axis] += std::copysign(task.goal_tolerance_m, out[axis]);
      if (std::abs(out[axis]) >= nearest_m) continue;
      nearest = displaced(task.goal, out);
      nearest_m = std::abs(out[axis]);
    }
  }
  return nearest;
}

}  // namespace

std::vector<Pose> goal_attractors(const Task& task, const Belief& start, SuccessorEngine& succ) {
  std::vector<Pose> goals = {task.goal};
  if (const std::optional<Pose> mouth = mouth_of_goal(task, start.particles.front(), succ)) {
    goals.push_back(*mouth);
  }
  return goals;
}

}  // namespace tenon::planner
