#pragma once
// The part in an arm's hand: a body that is next to massless, behind a spring and a damper that
// yield to forces and not to torques. Private to sim; one thread.
//
// While nothing touches it and it stands where the link does, it is the link's own, and the solver
// has a body and six rows less.

#include <ode/ode.h>

#include "sim/physics/solver/ode_world.h"

namespace tenon::sim {

class HeldPart {
 public:
  /// Stands where the link does. @param give_mpN along every axis; 0 is rigid
  HeldPart(const OdeWorld& world, dBodyID link, double give_mpN);
  HeldPart(const HeldPart&) = delete;
  HeldPart& operator=(const HeldPart&) = delete;

  [[nodiscard]] dBodyID body() const { return body_; }
  /// How far a force has pushed it from the link, world axes, m.
  [[nodiscard]] Vector3 bent_m() const;

  /// Sets spring and damper for the coming step. Call before OdeWorld::step().
  /// @param touched something may push it in this step
  void prepare(double step_s, bool touched);
  /// Goes with the link where it is its own. Call after OdeWorld::step().
  void follow();

 private:
  dBodyID link_;
  dBodyID body_;
  dJointID joint_;
  double give_mpN_;
  bool rides_ = false;  ///< is the link's own
};

}  // namespace tenon::sim
