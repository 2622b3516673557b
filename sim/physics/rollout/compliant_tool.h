#pragma once
// A free body that follows a setpoint through the compliance law. Private to sim.

#include <ode/ode.h>

#include <cstdint>

#include "shared/motion/guarded_move.h"
#include "shared/motion/move_parameters.h"
#include "sim/physics/solver/ode_world.h"

namespace tenon::sim {

/// M (x'' - xs'') + D (x' - xs') + K (x - xs) = f for a body whose origin is the tool tip. The
/// spring and the damper are velocity constraints with the right softness, which dWorldStep
/// integrates implicitly: stable for any stiffness and step. Axes that do not yield follow the
/// setpoint.
class CompliantTool {
 public:
  CompliantTool(OdeWorld& world, const Compliance& compliance);
  CompliantTool(const CompliantTool&) = delete;
  CompliantTool& operator=(const CompliantTool&) = delete;
  ~CompliantTool();

  void set_compliance(const Compliance& compliance);
  /// At rest at a pose.
  void place(const Pose& pose);
  [[nodiscard]] Pose pose() const { return pose_of(body_); }
  [[nodiscard]] dBodyID body() const { return body_; }

  /// Sets the drive for the coming step. Call before OdeWorld::step().
  void drive(const GuardedMove::Setpoint& setpoint, double step_s);

 private:
  Compliance compliance_;
  dBodyID body_;
  dJointID translation_;
  dJointID rotation_;
};

}  // namespace tenon::sim
