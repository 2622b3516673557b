#pragma once
// Where two shapes touch: the raw points, before contact_points.h thins them out. Private to sim.

#include <ode/ode.h>

#include <array>
#include <cstddef>
#include <span>

#include "sim/physics/surfaces/shape_geometry.h"

namespace tenon::sim {

/// The most points of one pair of shapes.
inline constexpr std::size_t kPointsAPair = 8;
using PairPoints = std::array<dContactGeom, kPointsAPair>;

/// Points at which two shapes touch or overlap, empty where they are apart; normals are towards
/// `held`. The same poses give the same points in the same order.
/// @param found where they are put
[[nodiscard]] std::span<const dContactGeom> touching_points(const ShapeGeometry& held,
                                                            const ShapeGeometry& environment,
                                                            PairPoints& found);

}  // namespace tenon::sim
