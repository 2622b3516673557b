#pragma once
// How far two bodies of triangles are apart, or how deep in each other, wherever they stand. Pure.

#include <memory>
#include <vector>

#include "shared/geometry/solid.h"
#include "shared/math/pose.h"

namespace tenon::planner {

/// Looks at points along the outward edges of both: where two bodies meet, one of these is on the
/// other's surface; and inwards of those that are, how deep both are in each other.
class SolidGap {
 public:
  SolidGap(std::shared_ptr<const Solid> held, std::shared_ptr<const Solid> environment);

  /// Negative where they overlap, m; `far_m` where they are farther apart.
  /// @param X_EH the held solid's own frame, its middle, in that of the environment's
  [[nodiscard]] double gap_m(const Pose& X_EH, double far_m) const;

  /// On an edge.
  struct EdgePoint {
    Vector3 at_m;
    Vector3 inwards;  ///< as Solid::Edge::inwards; zero where edges meet
  };

 private:
  std::shared_ptr<const Solid> held_;
  std::shared_ptr<const Solid> environment_;
  std::vector<EdgePoint> held_points_;
  std::vector<EdgePoint> environment_points_;
};

}  // namespace tenon::planner
