#include "planner/belief/belief.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tenon::planner {
namespace {

// The grid's cells, of the goal's tolerance.
constexpr double kCellOfTolerance = 0.1;

Eigen::Quaterniond mean_orientation(const Belief& belief) {
  // Newton's iteration on the rotation group; quadratic, a few steps.
  constexpr int kMaxIterations = 32;
  constexpr double kConverged_rad = 1e-13;
  Eigen::Quaterniond mean = belief.particles.front().tool().orientation;
  for (int i = 0; i < kMaxIterations; ++i) {
    Vector3 correction_rad = Vector3::Zero();
    for (const Particle& particle : belief.particles) {
      correction_rad += rotation_vector(particle.tool().orientation * mean.conjugate());
    }
    correction_rad /= static_cast<double>(belief.particles.size());
    if (correction_rad.norm() < kConverged_rad) break;
    mean = (rotation_of(correction_rad) * mean).normalized();
  }
  return mean;
}

std::int64_t cell(double value, double size) {
  return static_cast<std::int64_t>(std::floor(value / size + 0.5));
}

}  // namespace

Metric metric_of(const Task& task) {
  Metric metric{task.orientation_weight};
  for (int axis = 0; axis < 6; ++axis) {
    if (task.goal_axes.together(axis)) continue;
    metric.own |= static_cast<CoordinateMask>(1U << axis);
    if (has(task.goal_axes.free, axis)) continue;
    const double ratio = task.goal_tolerance_m / task.goal_axes.tolerance[axis];
    metric.own_variance[axis] = ratio * ratio;
  }
  for (int axis = 3; axis < 6; ++axis) {
    if (!has(task.coordinates, axis)) metric.own |= static_cast<CoordinateMask>(1U << axis);
  }
  return metric;
}

std::vector<Vector3> sensor_errors(const Task& task) {
  std::vector<Vector3> errors = {Vector3::Zero()};
  constexpr unsigned kRotations = 0b111000;
  if ((task.compliance.compliant_axes & kRotations) == 0 || task.sensor_error_m == 0.0) {
    return errors;
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const double error_m : {task.sensor_error_m, -task.sensor_error_m}) {
      errors.emplace_back(error_m * Vector3::Unit(axis));
    }
  }
  return errors;
}

Particle particle_off(const Vector6& off, const Task& task, const Start& start,
                      const PhysicalParameters& physics) {
  Vector6 turn = Vector6::Zero();
  turn.tail<3>() = -off.tail<3>();
  return {{start.pose.position_m + off.head<3>(), start.pose.orientation},
          {},
          physics,
          environment_pose(turn, task.error_about_m)};
}

Belief cross_polytope(const Task& task, const Start& start) {
  Belief belief;
  // The two tips of an axis have both extremes of friction, and the next axis has them the other
  // way round, so that friction is not tied to one direction.
  bool slippery = true;
  for (int axis = 0; axis < 6; ++axis) {
    const double offset = task.particle_sigmas * start.sigma[axis];
    if (!has(task.coordinates, axis) || offset == 0.0) continue;
    for (const double sign : {+1.0, -1.0}) {
      Vector6 displacement = Vector6::Zero();
      displacement[axis] = sign * offset;
      const double friction = slippery ? task.friction.low : task.friction.high;
      belief.particles.push_back(particle_off(
          displacement, task, start, {friction, task.contact_stiffness_Npm, task.oversize_m}));
      slippery = !slippery;
    }
    slippery = !slippery;
  }
  return belief.particles.empty() ? single_particle(task, start) : belief;
}

Belief single_particle(const Task& task, const Start& start) {
  return {{{start.pose, {}, {task.friction.nominal, task.contact_stiffness_Npm}, {}}}};
}

Belief start_belief(const Task& task, const Start& start, PlanMethod method) {
  return method == PlanMethod::kMha ? cross_polytope(task, start) : single_particle(task, start);
}

Belief in_cell(Belief belief, double contact_stiffness_Npm, double latency_max_s) {
  bool late = false;
  for (Particle& particle : belief.particles) {
    particle.physics.contact_stiffness_Npm = contact_stiffness_Npm;
    particle.physics.latency_s = late ? latency_max_s : 0.0;
    late = !late;
  }
  return belief;
}

Pose mean_pose(const Belief& belief) {
  Pose mean;
  for (const Particle& particle : belief.particles) mean.position_m += particle.tool().position_m;
  mean.position_m /= static_cast<double>(belief.particles.size());
  mean.orientation = mean_orientation(belief);
  return mean;
}

double uncertainty(const Belief& belief, const Metric& metric) {
  const Pose mean = mean_pose(belief);
  double position_m2 = 0.0;
  double orientation_rad2 = 0.0;
  Vector6 own = Vector6::Zero();
  for (const Particle& particle : belief.particles) {
    Vector6 off = displacement_between(mean, particle.tool());
    for (int axis = 0; axis < 6; ++axis) {
      if (!has(metric.own, axis)) continue;
      own[axis] += off[axis] * off[axis];
      off[axis] = 0.0;
    }
    position_m2 += off.head<3>().squaredNorm();
    orientation_rad2 += off.tail<3>().squaredNorm();
  }
  const auto count = static_cast<double>(belief.particles.size());
  return (position_m2 + metric.orientation_weight * orientation_rad2 +
          own.dot(metric.own_variance)) /
         count;
}

double distance(const Pose& a, const Pose& b, const Metric& metric) {
  const Vector6 between = displacement_between(a, b);
  return between.head<3>().norm() + metric.orientation_weight * between.tail<3>().norm();
}

void append_cell(const Particle& particle, double cell_m, double cell_rad,
                 std::vector<std::int64_t>& key) {
  for (const Pose* pose : {&particle.pose, &particle.environment}) {
    const Vector3 turn_rad = rotation_vector(pose->orientation);
    for (int i = 0; i < 3; ++i) key.push_back(cell(pose->position_m[i], cell_m));
    for (int i = 0; i < 3; ++i) key.push_back(cell(turn_rad[i], cell_rad));
  }
  key.push_back(particle.signature.bits);
  key.push_back(std::bit_cast<std::int64_t>(particle.physics.friction));
  key.push_back(std::bit_cast<std::int64_t>(particle.physics.contact_stiffness_Npm));
  key.push_back(std::bit_cast<std::int64_t>(particle.physics.oversize_m));
  key.push_back(std::bit_cast<std::int64_t>(particle.physics.latency_s));
  for (const double error_m : particle.physics.sensor_error_m) {
    key.push_back(std::bit_cast<std::int64_t>(error_m));
  }
}

Grid grid_of(const Task& task) {
  const Grid coarsest;
  double finest_m = task.goal_tolerance_m;
  double finest_rad = finest_m / task.orientation_weight;
  for (int axis = 0; axis < 6; ++axis) {
    const double own = task.goal_axes.tolerance[axis];
    double& finest = axis < 3 ? finest_m : finest_rad;
    if (own > 0.0) finest = std::min(finest, own);
  }
  return {std::min(coarsest.cell_m, kCellOfTolerance * finest_m),
          std::min(coarsest.cell_rad, kCellOfTolerance * finest_rad)};
}

BeliefKey identity(const Belief& belief, const Grid& grid) {
  BeliefKey key;
  for (const Particle& particle : belief.particles) {
    append_cell(particle, grid.cell_m, grid.cell_rad, key);
  }
  return key;
}

}  // namespace tenon::planner
