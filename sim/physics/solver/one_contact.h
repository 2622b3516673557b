#pragma once
// One contact of a part that cannot rotate, without the solver. Private to sim; pure.

#include <ode/ode.h>

#include <optional>

#include "shared/math/pose.h"
#include "sim/physics/contacts/contact_law.h"

namespace tenon::sim {

/// What dWorldStep finds for a single contact point, normal and friction, in closed form: along the
/// normal and the two directions of friction the body gives way on its own in each, so that the
/// rows of the complementarity problem do not couple.
/// @param velocity_mps that the body would have after the step if the contact were not there
/// @param give_mpspN by how much a force along each of the world's axes changes that velocity; 0
/// for an axis that is held
/// @return force on the body, N; empty where the rows do couple (a face askew to axes of which some
/// are held): the solver's work
[[nodiscard]] std::optional<Vector3> one_contact_force(const dContactGeom& point,
                                                       const ContactLaw& law,
                                                       const Vector3& velocity_mps,
                                                       const Vector3& give_mpspN, double step_s);

}  // namespace tenon::sim
