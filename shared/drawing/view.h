#pragma once
// From which side a picture of a task is seen. Pure; any thread.

#include <Eigen/Core>
#include <vector>

#include "shared/math/pose.h"
#include "shared/plan/plan.h"

namespace tenon::drawing {

using Point = Eigen::Vector2d;  ///< to the right, up

/// Two axes (0..2) of the task frame on the page, and the third that is looked along.
struct View {
  int right = 0;
  int up = 1;
  int along = 2;
  const char* title = "";

  [[nodiscard]] Point m(const Vector3& position_m) const {
    return {position_m[right], position_m[up]};
  }
  [[nodiscard]] Point mm(const Vector3& position_m) const { return 1e3 * m(position_m); }
};

/// What shows the coordinates of a task: the plane that it is uncertain in, two of them (from above
/// and from the side) where that is space.
[[nodiscard]] std::vector<View> views_of(CoordinateMask coordinates);

}  // namespace tenon::drawing
