#pragma once
// Shapes as a view along an axis shows them. Private to sim/evaluation.

#include <vector>

#include "shared/drawing/view.h"
#include "shared/task/task.h"

namespace tenon::sim {

/// The silhouette, in mm, counterclockwise. @param frame that the shape's pose is in
[[nodiscard]] std::vector<drawing::Point> outline(const Shape& shape, const Pose& frame,
                                                  const drawing::View& view);

/// Whether both are somewhere equally far along the view: else one passes over the other.
[[nodiscard]] bool share_depth(const Shape& a, const Pose& frame_a, const Shape& b,
                               const Pose& frame_b, const drawing::View& view);

}  // namespace tenon::sim
