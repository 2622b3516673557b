#pragma once
// Shapes as a view along an axis shows them. Private to sim/evaluation.

#include <vector>

#include "shared/task/task.h"
#include "sim/evaluation/plot.h"

namespace tenon::sim {

/// Two axes (0..2) of the task frame on the page, and the one that it looks along.
struct View {
  int right = 0;
  int up = 1;
  int depth = 2;

  [[nodiscard]] Point operator()(const Vector3& position_m) const {
    return {1e3 * position_m[right], 1e3 * position_m[up]};  // people measure in mm
  }
};

/// The plane that a task is uncertain in; two of them where that is space.
[[nodiscard]] std::vector<View> views_of(CoordinateMask coordinates);

/// The silhouette, in mm, counterclockwise. @param frame that the shape's pose is in
[[nodiscard]] std::vector<Point> outline(const Shape& shape, const Pose& frame, const View& view);

/// Whether both are somewhere equally far along the view: else one passes over the other.
[[nodiscard]] bool share_depth(const Shape& a, const Pose& frame_a, const Shape& b,
                               const Pose& frame_b, const View& view);

}  // namespace tenon::sim
