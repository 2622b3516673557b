#pragma once
// Where two upright shapes touch that can turn against each other. Private to sim; pure.

#include <ode/ode.h>

#include <optional>
#include <span>

#include "sim/physics/contacts/touching_points.h"
#include "sim/physics/surfaces/shape_geometry.h"

namespace tenon::sim {

/// The corners of the area in which two shapes with an axis in common press against each other, on
/// the face through which the way out is shortest: those of the edge or the point that is deepest,
/// at both ends of what they share of the axis, or those of the outlines' common area. Each has its
/// own depth, so that a part that stands askew is turned by them. Empty where the shapes have no
/// axis in common; a span without points where they are apart.
/// @param found where they are put
[[nodiscard]] std::optional<std::span<const dContactGeom>> prism_manifold(
    const ShapeGeometry& held, const ShapeGeometry& environment, PairPoints& found);

}  // namespace tenon::sim
