#pragma once
// An assembly problem: what planner/tasks/*.yaml say. Loading stands in shared/config.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shared/math/pose.h"
#include "shared/motion/move_parameters.h"
#include "shared/plan/plan.h"

namespace tenon {

class Solid;

struct Range {
  double low = 0.0;
  double nominal = 0.0;
  double high = 0.0;
};

/// A rigid piece of the held part or of the environment.
struct Shape {
  enum class Kind : std::uint8_t { kBox, kCylinder, kSolid };
  std::string name;
  Kind kind = Kind::kBox;
  /// Box: edge lengths; cylinder: diameter, diameter, length along z; solid: of the box around it.
  /// A solid larger or smaller than that stands out farther, along x everywhere by half of it.
  Vector3 size_m = Vector3::Zero();
  Pose pose;  ///< of its centre, in the tool frame (held) or the task frame
  std::shared_ptr<const Solid> solid = nullptr;  ///< a mesh or an extrusion
};

/// A part of space, in the task frame.
struct BoxRegion {
  Vector3 size_m = Vector3::Zero();  ///< edge lengths
  Pose pose;                         ///< of its centre
};

/// How the errors of a task's starts are distributed, each coordinate by itself.
enum class Distribution : std::uint8_t {
  kNormal,
  kUniform,  ///< as likely anywhere within a bound, which is sqrt(3) standard deviations
};

/// A named nominal start.
struct Start {
  std::string name;
  Pose pose;                        ///< tool in task frame
  Vector6 sigma = Vector6::Zero();  ///< standard deviation a coordinate, m or rad; 0 off the search
};

struct Task {
  std::string name;        ///< that of a variant is "task/variant"
  std::uint64_t hash = 0;  ///< of the file's bytes and the variant's name
  CoordinateMask coordinates = 0;
  std::vector<Shape> held;
  std::vector<Shape> environment;
  std::vector<Start> starts;
  /// What an error of the environment's rotation leaves where it is, task frame.
  Vector3 error_about_m = Vector3::Zero();
  Distribution errors = Distribution::kNormal;  ///< of all starts
  /// c_p: how many standard deviations out the particles sit; sqrt(3) where errors are uniform.
  double particle_sigmas = 2.0;

  Pose goal;
  double goal_tolerance_m = 2e-3;     ///< d_tol
  GoalAxes goal_axes;                 ///< that do not count in it; only coordinates
  double goal_uncertainty_m2 = 2e-6;  ///< u_tol; 0: what the room at the goal allows, see planner/
  std::optional<BoxRegion> inserted;  ///< where every tool tip must end besides; see inserted.h

  // Primitives.
  double step_m = 0.10;
  double step_rad = 0.1;
  double long_step_m = 1.0;     ///< for the attractor search
  double direct_reach_m = 0.3;  ///< the mean-to-goal primitive exists within this distance
  /// Besides those, moves that guides suggest: to where a push begins, the push, to a goal's
  /// coordinates one after the other.
  bool guide_moves = false;

  ParameterSet motion;
  Compliance compliance;
  double force_limit_N = 20.0;
  double torque_limit_Nm = 2.0;

  // Search.
  double w1 = 3.0;
  double w2 = 3.0;
  double distance_weight_per_m = 5e3;        ///< w_d
  double uncertainty_weight_per_m2 = 2.5e6;  ///< w_u
  double move_weight = 0.0;                  ///< w_m, of every move; none in the paper
  double orientation_weight = 0.1;           ///< w_o, m per rad; a metre of way weighs 1
  double attractor_ratio = 0.6;              ///< c_u
  std::size_t attractor_samples = 0;         ///< drawn places, where start and goal do not suffice
  double time_limit_s = 60.0;

  Range friction{0.1, 0.3, 0.6};
  double contact_stiffness_Npm = 5e4;
  /// A contact may give way by up to so much more, m per N, than the above or the cell's says: what
  /// parts yield, whatever the arm does.
  double contact_give_mpN = 0.0;
  double oversize_m = 0.0;  ///< the held part may be larger than drawn by up to this, in every size
  /// Calibration may have turned the environment, and the part in the hand, by up to this about any
  /// axis that is no coordinate.
  double tilt_rad = 0.0;
  /// The force sensor may measure that far from where the cell has it, along any of its axes: what
  /// moves that yield in rotation feel as a torque.
  double sensor_error_m = 0.0;
  std::int64_t rollout_step_us = 2000;
};

}  // namespace tenon
