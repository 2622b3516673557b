#pragma once
// A belief: where the tool may be, as a handful of particles at rest. Its mean, its uncertainty,
// its distance to another, and the identity by which the search recognises it. Pure functions; any
// thread; nothing here simulates.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "shared/ports/arm_reach.h"
#include "shared/ports/rollout.h"
#include "shared/task/task.h"

namespace tenon::planner {

struct Belief {
  std::vector<Particle> particles;  ///< never empty
  /// Where the moves that led here may have brought the arm. Null where no arm is asked, and of a
  /// belief that no moves led to.
  std::shared_ptr<const ArmPlace> arm = nullptr;
};

/// What an angle weighs beside a way, the same in distances and in uncertainties. Ways weigh 1, so
/// that tolerances are metres. Where the goal has axes of its own, their variances weigh as their
/// tolerances do; those of free axes and of rotations that are no coordinate weigh nothing.
struct Metric {
  double orientation_weight = 0.1;         ///< m per rad
  Vector6 own_variance = Vector6::Zero();  ///< m^2 per m^2 or rad^2, of the axes in own
  CoordinateMask own = 0;                  ///< which do not weigh as all others

  /// Of an axis's variance, m^2 per m^2 or rad^2.
  [[nodiscard]] double variance_weight(int axis) const {
    if (has(own, axis)) return own_variance[axis];
    return axis < 3 ? 1.0 : orientation_weight;
  }
};

[[nodiscard]] Metric metric_of(const Task& task);

/// How far off the force sensor may be: not at all, then as far as the task says along each axis
/// either way. Not at all alone where no move yields in rotation, and so a torque turns nothing.
[[nodiscard]] std::vector<Vector3> sensor_errors(const Task& task);

/// A tool that stands at its nominal start, seen by an environment that is off: nothing touches.
/// @param off of the tool, along the task's axes and about them at the task's error_about_m; the
/// environment's error is as much the other way
[[nodiscard]] Particle particle_off(const Vector6& off, const Task& task, const Start& start,
                                    const PhysicalParameters& physics);

/// The tips of the cross-polytope: nominal +- c_p sigma along every search coordinate that has a
/// sigma; the nominal pose alone where none has. Nothing touches. Friction is uncertain too: the
/// tips take turns between its extremes.
[[nodiscard]] Belief cross_polytope(const Task& task, const Start& start);

/// The nominal pose alone, at nominal friction: what a planner without a notion of uncertainty
/// sees.
[[nodiscard]] Belief single_particle(const Task& task, const Start& start);

/// What a method plans for: all of the cross-polytope, or the single particle.
[[nodiscard]] Belief start_belief(const Task& task, const Start& start, PlanMethod method);

/// The belief in a cell: its contact stiffness, and of its latency the two extremes, none and the
/// longest, in turns. The first particle, and so a single one, has none.
[[nodiscard]] Belief in_cell(Belief belief, double contact_stiffness_Npm, double latency_max_s);

/// Of the tools in the task frame as it really stands: mean position, and the rotation from which
/// the rotation vectors to all others sum up to zero.
[[nodiscard]] Pose mean_pose(const Belief& belief);

/// u = Tr Cov(position) + w_o Tr Cov(orientation), population covariances, the orientation as
/// rotation vectors about the mean (m^2). Axes of their own weigh as the metric says.
[[nodiscard]] double uncertainty(const Belief& belief, const Metric& metric);

/// |position difference| + w_o (angle between), m. A metric.
[[nodiscard]] double distance(const Pose& a, const Pose& b, const Metric& metric);

/// The grid on which beliefs are told apart.
struct Grid {
  double cell_m = 1e-4;
  double cell_rad = 0.02 * 3.14159265358979323846 / 180.0;
};

/// 0.1 mm and 0.02 degrees (a clearance is a few of them), and at most a tenth of the goal's
/// narrowest tolerance: one state's particles are as far from the goal as each other, but for that.
[[nodiscard]] Grid grid_of(const Task& task);

/// Two beliefs with equal keys are one state of the search: every particle in the same cell and
/// with the same contacts. States that differ only in their contacts differ: pressing and not
/// pressing against a wall have different successors.
using BeliefKey = std::vector<std::int64_t>;
[[nodiscard]] BeliefKey identity(const Belief& belief, const Grid& grid);

/// The cell of one particle on a grid of that size.
void append_cell(const Particle& particle, double cell_m, double cell_rad,
                 std::vector<std::int64_t>& key);

}  // namespace tenon::planner
