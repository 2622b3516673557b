#pragma once
// Whether a surface goes through itself. Pure.

#include <cstddef>
#include <optional>

#include "shared/geometry/triangle_mesh.h"

namespace tenon {

struct SelfIntersection {
  std::size_t triangles =
      0;         ///< an edge of each goes through another triangle, or folds back on it
  Vector3 at_m;  ///< of the first
};

/// Parts of the surface that only touch do not count.
[[nodiscard]] std::optional<SelfIntersection> self_intersection(const TriangleMesh& mesh);

}  // namespace tenon
