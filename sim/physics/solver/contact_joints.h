#pragma once
// Contact points as constraints of the solver, and the forces that it found for them. Private to
// sim; one thread.

#include <ode/ode.h>

#include <vector>

#include "shared/math/pose.h"
#include "sim/physics/contacts/contact_law.h"
#include "sim/physics/solver/ode_world.h"

namespace tenon::sim {

class ContactJoints {
 public:
  /// One joint a point, in their order, in place of those of the step before. Call before
  /// OdeWorld::step().
  void make(OdeWorld& world, const std::vector<dContactGeom>& points, const ContactLaw& law,
            double step_s);

  /// After the step: force and torque on the body of each point's first geometry, summed; world
  /// axes, about the body's origin.
  [[nodiscard]] Vector6 wrench() const;

 private:
  std::vector<dJointFeedback> feedback_;  // one a point
};

}  // namespace tenon::sim
