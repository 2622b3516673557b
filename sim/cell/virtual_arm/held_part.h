#pragma once
// The part in an arm's hand: a body that is next to massless, behind a spring and a damper that
// yield to forces and not to torques. Private to sim; one thread.
//
// While nothing touches it and it stands where the link has it, it rides with the link.

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
  [[nodiscard]] Vector3 bent_m() const { return bent_m_; }
  /// Whether it stands where the link has it.
  [[nodiscard]] bool there() const;

  /// The link has been put somewhere, and the part with it.
  void ride(const BodyState& link);
  /// Before a step of the world, and after it. @param touched something may push it in that step
  void load(double step_s, bool touched);
  void look();

 private:
  dBodyID link_;
  dBodyID body_;
  dJointID joint_;
  double give_mpN_;
  Vector3 bent_m_ = Vector3::Zero();
  bool rides_ = false;  ///< in the last step of the world
};

}  // namespace tenon::sim
