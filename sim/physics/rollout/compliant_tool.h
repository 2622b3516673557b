#pragma once
// A free body that follows a setpoint through the compliance law. Private to sim.

#include <ode/ode.h>

#include <cstdint>

#include "shared/motion/admittance.h"
#include "shared/motion/guarded_move.h"
#include "shared/motion/move_parameters.h"
#include "sim/physics/solver/ode_world.h"

namespace tenon::sim {

/// M (x'' - xs'') + D (x' - xs') + K (x - xs) = f for a body whose origin is the tool tip, in two
/// ways that agree. Among contacts the spring and the damper are velocity constraints with the
/// right softness, which dWorldStep integrates implicitly: stable for any stiffness and step. Where
/// the force is known beforehand, in free flight above all, the same implicit step has a closed
/// form, the Admittance, at a tenth of the time. Axes that do not yield follow the setpoint.
class CompliantTool {
 public:
  CompliantTool(OdeWorld& world, const Compliance& compliance);
  CompliantTool(const CompliantTool&) = delete;
  CompliantTool& operator=(const CompliantTool&) = delete;
  ~CompliantTool();

  /// What the coming moves are made with.
  /// @param turns whether anything can rotate the tool; else its orientation is held as it is, and
  /// the solver has no rotation to solve for
  void set_compliance(const Compliance& compliance, bool turns = true);
  /// At rest at a pose; the body too.
  void place(const Pose& pose);
  [[nodiscard]] const Pose& pose() const { return tool_.state().pose; }
  [[nodiscard]] dBodyID body() const { return body_; }

  /// One step under a known force (world axes, about the body's origin). The body stays behind
  /// until it is needed.
  void fly(const GuardedMove::Setpoint& setpoint, double step_s,
           const Vector6& wrench = Vector6::Zero());
  /// The translational velocity that fly() would leave the tool with, and by how much a force along
  /// each axis would change it (m/s a N; 0 for an axis that does not yield).
  [[nodiscard]] Vector3 free_velocity_mps(const GuardedMove::Setpoint& setpoint,
                                          double step_s) const;
  [[nodiscard]] Vector3 give_mpspN(double step_s) const;
  /// Brings the body to where the tool is, for collisions.
  void show();
  /// Sets the drive for the coming step of a shown body. Call before OdeWorld::step().
  void drive(const GuardedMove::Setpoint& setpoint, double step_s);
  /// Takes the tool to where the step has brought the body. Call after OdeWorld::step().
  void follow();

 private:
  Compliance compliance_;
  Admittance tool_;
  bool turns_ = true;
  bool shown_ = false;  ///< the body is where the tool is
  dBodyID body_;
  dJointID translation_;
  dJointID rotation_;
};

}  // namespace tenon::sim
