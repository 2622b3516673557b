#pragma once
// Where to hold a part so that pushes against walls do not turn it. Pure; any thread.

#include <Eigen/Core>
#include <optional>

#include "shared/geometry/triangle_mesh.h"

namespace tenon::planner {

/// Of a part that is cut across z: the place from which, along x and along y, both ways, its
/// outermost points are straight ahead, or as nearly so as there is one. What is pushed there
/// against a wall, and yields, stays as it is turned. Empty where nothing is cut.
[[nodiscard]] std::optional<Eigen::Vector2d> push_middle_m(const TriangleMesh& part, double z_m);

}  // namespace tenon::planner
