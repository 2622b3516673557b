#include "planner/belief/corners.h"

#include <algorithm>
#include <array>
#include <vector>

namespace tenon::planner {
namespace {

constexpr std::size_t kFull = 4;

/// The sides on which the coordinates are, bit by bit: a two-level design of resolution IV.
unsigned sides_of(unsigned corner) {
  const auto bit = [corner](unsigned i) { return corner >> i & 1U; };
  return corner | (bit(0) ^ bit(1) ^ bit(2)) << kFull | (bit(1) ^ bit(2) ^ bit(3)) << (kFull + 1);
}

}  // namespace

Belief corner_belief(const Task& task, const Start& start) {
  std::vector<int> axes;
  for (int axis = 0; axis < 6; ++axis) {
    if (has(task.coordinates, axis) && start.sigma[axis] > 0.0) axes.push_back(axis);
  }
  if (axes.empty()) return single_particle(task, start);
  const double out = task.particle_sigmas;
  const std::vector<Vector3> errors = sensor_errors(task);
  Belief belief;
  for (unsigned corner = 0; corner < 1U << std::min(axes.size(), kFull); ++corner) {
    Vector6 side = Vector6::Zero();
    for (std::size_t i = 0; i < axes.size(); ++i) {
      side[axes[i]] = (sides_of(corner) >> i & 1U) != 0 ? 1.0 : -1.0;
    }
    if (task.errors != Distribution::kUniform) side.normalize();
    const double friction = (corner >> 1U & 1U) != 0 ? task.friction.low : task.friction.high;
    Particle particle = particle_off(out * side.cwiseProduct(start.sigma), task, start,
                                     {friction, task.contact_stiffness_Npm, task.oversize_m});
    particle.physics.sensor_error_m = errors[corner % errors.size()];
    belief.particles.push_back(particle);
  }
  return belief;
}

}  // namespace tenon::planner
