#pragma once
// Triangles as a file or a generator gives them. Plain data.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shared/math/pose.h"

namespace tenon {

/// Corners, counterclockwise as seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// A surface of triangles; check_closed() in mesh_check.h says whether it encloses anything.
struct TriangleMesh {
  /// More are refused: of so many a task needs some 100 MB.
  static constexpr std::size_t kTrianglesMax = 200'000;

  std::vector<Vector3> points_m;
  std::vector<Triangle> triangles;

  [[nodiscard]] std::array<Vector3, 3> corners_m(std::size_t triangle) const {
    const Triangle& t = triangles[triangle];
    return {points_m[t[0]], points_m[t[1]], points_m[t[2]]};
  }
};

/// Points that are the same numbers become one, in the order of their first use.
[[nodiscard]] TriangleMesh welded(const TriangleMesh& mesh);

}  // namespace tenon
