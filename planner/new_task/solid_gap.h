#pragma once
// How far two bodies of triangles are apart, or how deep in each other, wherever they stand. Pure.

#include <memory>
#include <vector>

#include "shared/geometry/solid.h"
#include "shared/math/pose.h"

namespace tenon::planner {

/// Looks at points along the outward edges of both: where two bodies meet, one of these is on the
/// other's surface.
class SolidGap {
 public:
  SolidGap(std::shared_ptr<const Solid> held, std::shared_ptr<const Solid> environment);

  /// Negative where they overlap, m; `far_m` where they are farther apart.
  /// @param X_EH the held solid's own frame, its middle, in that of the environment's
  [[nodiscard]] double gap_m(const Pose& X_EH, double far_m) const;

 private:
  std::shared_ptr<const Solid> held_;
  std::shared_ptr<const Solid> environment_;
  std::vector<Vector3> held_points_m_;
  std::vector<Vector3> environment_points_m_;
};

}  // namespace tenon::planner
