#pragma once
// The shapes of a task as ODE geometry, and the contacts between them. Private to sim.

#include <ode/ode.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "shared/math/pose.h"
#include "shared/task/task.h"
#include "sim/ode/ode_world.h"

namespace tenon::sim {

/// How two surfaces meet. The stiffness is that of a whole face, however many shapes it is made of:
/// it is shared out among its contact points.
struct Surface {
  double friction = 0.3;
  double stiffness_Npm = 5e4;
  double relaxation_s = 2e-3;  ///< damping over stiffness
};

/// Contact geometry of the held part against the environment. Pairs are collided in a fixed order,
/// so that the solver sees the same constraints in the same order whatever happened before.
class Scene {
 public:
  /// @param X_WT where the environment's task frame stands in the world
  Scene(const std::vector<Shape>& held, const std::vector<Shape>& environment,
        const Pose& X_WT = {});
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  ~Scene();

  /// Hangs the held shapes on a body. @param X_BP the tool frame in the body's frame
  void attach(dBodyID body, const Pose& X_BP = {});

  /// Every size of the held part as drawn and this much more.
  void set_oversize(double oversize_m);

  struct Contacts {
    std::size_t points = 0;
    double depth_max_m = 0.0;
  };
  /// Makes this step's contact joints. Call before OdeWorld::step().
  Contacts collide(OdeWorld& world, double step_s, const Surface& surface);

  /// After the step: force and torque of the environment on the attached body, world axes, about
  /// the body's origin.
  [[nodiscard]] Vector6 wrench() const;

  /// Deepest overlap at the body's present pose, m; 0 where nothing touches.
  [[nodiscard]] double overlap_m() const;

  /// Indices of two shapes that touch.
  struct Pair {
    std::size_t held = 0;
    std::size_t environment = 0;
  };
  /// Of the last collide(), each pair once.
  [[nodiscard]] const std::vector<Pair>& pairs() const { return touching_; }
  /// "held-environment"
  [[nodiscard]] std::string name(const Pair& pair) const;
  /// The names of all pairs.
  [[nodiscard]] std::vector<std::string> touching() const;

 private:
  static constexpr int kPointsAPair = 8;

  void make_joints(OdeWorld& world, double step_s, const Surface& surface);

  std::vector<std::string> held_names_;
  std::vector<std::string> environment_names_;
  std::vector<dGeomID> held_;
  std::vector<Pose> held_offsets_;
  std::vector<Vector3> held_sizes_m_;  // as drawn
  double oversize_m_ = 0.0;
  std::vector<dGeomID> environment_;
  std::vector<dContactGeom> points_;      // of the last collide(), thinned out
  std::vector<dJointFeedback> feedback_;  // one a point
  std::vector<Pair> touching_;
};

}  // namespace tenon::sim
