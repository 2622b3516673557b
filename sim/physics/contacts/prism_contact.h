#pragma once
// Where two upright shapes touch that cannot turn against each other. Private to sim; pure.

#include <ode/ode.h>

#include <optional>

#include "sim/physics/surfaces/prism.h"
#include "sim/physics/surfaces/shape_geometry.h"

namespace tenon::sim {

/// How deep two prisms on a common axis are in each other, and the way out, by the separating axis
/// theorem: along the axis, or across it between their outlines, whichever is shorter.
struct PrismOverlap {
  double depth_m = 0.0;  ///< negative: apart by at least so much
  Vector3 normal;        ///< the way out for the first
  Vector3 at_m;          ///< on the environment's face
};
[[nodiscard]] PrismOverlap overlap(const Prism& held, const Prism& environment);

/// The deepest point of contact of two shapes with an axis in common (boxes that stand along each
/// other's axes, a cylinder upright on a box), at a fraction of what the general collision of ODE
/// costs; depth negative where they are apart. Empty where they have no axis in common.
[[nodiscard]] std::optional<dContactGeom> prism_contact(const ShapeGeometry& held,
                                                        const ShapeGeometry& environment);

}  // namespace tenon::sim
