#pragma once
// A flat outline drawn out along its normal. Pure; throws InputError.

#include <Eigen/Core>
#include <vector>

#include "shared/geometry/triangle_mesh.h"

namespace tenon {

/// The outline in the plane z = 0, in order either way round, drawn out to half the length on both
/// sides. Refused: an outline that crosses or touches itself, or stays on a line.
/// @param profile_m at least three corners
/// @param length_m positive
[[nodiscard]] TriangleMesh extruded(std::vector<Eigen::Vector2d> profile_m, double length_m);

}  // namespace tenon
