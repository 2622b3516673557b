#pragma once
// Triangles without area, as exporters leave them where a corner of one face lies on an edge of
// another. Pure.

#include "shared/geometry/triangle_mesh.h"

namespace tenon {

/// The least height of a triangle, m: below, its side is lost in rounding.
inline constexpr double kTriangleHeightMin_m = 1e-11;
/// Rounding a file to six decimals turns a lower one about as it likes: where it faces says
/// nothing.
inline constexpr double kSliver_m = 2e-6;

/// Of a triangle's three heights the least, m; 0 where corners are the same.
[[nodiscard]] double height_m(const TriangleMesh& mesh, const Triangle& triangle);

/// The same surface without triangles lower than kTriangleHeightMin_m. Corners that are closer than
/// that become one; a corner that lies on the edge across from it becomes one of the triangle
/// beyond that edge, which is cut in two. What cannot be mended so stays as it is, and everything
/// does where every other triangle is flat: that is a wrong scale.
[[nodiscard]] TriangleMesh without_needles(const TriangleMesh& mesh);

}  // namespace tenon
