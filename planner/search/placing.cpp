#include "planner/search/placing.h"

#include <algorithm>
#include <cmath>

#include "planner/belief/primitives.h"

namespace tenon::planner {

Eigen::AlignedBox3d around(const std::vector<Shape>& shapes) {
  Eigen::AlignedBox3d box;
  for (const Shape& shape : shapes) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3 sign((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                         (corner & 4) != 0 ? 0.5 : -0.5);
      box.extend(shape.pose.position_m +
                 shape.pose.orientation * shape.size_m.cwiseProduct(sign).eval());
    }
  }
  return box;
}

Belief spread_about(const Pose& place, const Belief& belief, const Pose& mean, Rollout& rollout) {
  Belief there;
  for (Particle particle : belief.particles) {
    const Pose tool = displaced(place, displacement_between(mean, particle.tool()));
    if (rollout.in_collision(tool)) return {};
    particle.pose = seen_as(particle.environment, tool);
    particle.signature = {};
    there.particles.push_back(particle);
  }
  return there;
}

Vector6 aimed(const Pose& place, const Belief& belief, const Task& task) {
  Vector6 way = Vector6::Zero();
  if (task.motion.carried_axes) {
    for (const Particle& particle : belief.particles) {
      const Pose tool = particle.tool();
      way += in_move_axes(task, tool, displacement_between(tool, place));
    }
    way /= static_cast<double>(belief.particles.size());
  } else {
    way = displacement_between(mean_pose(belief), place);
  }
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(moved_axes(task), axis)) way[axis] = 0.0;
  }
  return way;
}

Belief moved_to(const Pose& place, const Belief& belief, const Task& task) {
  const Vector6 way = aimed(place, belief, task);
  Belief there = belief;
  for (Particle& particle : there.particles) {
    Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();
    if (task.motion.carried_axes) {
      axes = particle.pose.orientation * task.goal.orientation.conjugate();
    }
    const Pose own = compose({Vector3::Zero(), axes.conjugate()}, particle.pose);
    particle.pose = compose({Vector3::Zero(), axes}, displaced(own, way));
    particle.signature = {};
  }
  return there;
}

Vector3 turned_aside_m(const Vector6& spread, const Eigen::AlignedBox3d& part) {
  if (part.isEmpty()) return Vector3::Zero();
  const Vector3 reach_m = part.min().cwiseAbs().cwiseMax(part.max().cwiseAbs());
  Vector3 aside_m;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    aside_m[axis] = spread[3 + u] * reach_m[v] + spread[3 + v] * reach_m[u];
  }
  return aside_m;
}

}  // namespace tenon::planner
