#pragma once
// Shapes as prisms, and what a page shows of them. Pure; any thread.

#include <cstddef>
#include <vector>

#include "shared/drawing/view.h"
#include "shared/task/task.h"

namespace tenon::drawing {

/// So many corners below, as many above.
struct Prism {
  std::vector<Vector3> corners_m;

  [[nodiscard]] std::size_t sides() const { return corners_m.size() / 2; }
};

/// A box as it is; a cylinder with so many sides, the corners on its circle. Of a solid only the
/// corners mean something: all its points.
/// @param frame that the shape's pose is in
[[nodiscard]] Prism prism_of(const Shape& shape, const Pose& frame, int round_sides);

/// The convex hull, counterclockwise (Andrew's monotone chain).
[[nodiscard]] std::vector<Point> hull_of(std::vector<Point> points);

}  // namespace tenon::drawing
