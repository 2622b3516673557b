#pragma once
// What another library says of two bodies of triangles: whether they meet, by libfcl, and how deep
// one is in the other, by its distances and the winding number (Jacobson, Kavan and
// Sorkine-Hornung, "Robust inside-outside segmentation using generalized winding numbers"). It
// shares nothing with Tenon's own distances and contacts but the triangles.

#include <memory>

#include "shared/geometry/triangle_mesh.h"
#include "shared/math/pose.h"

namespace tenon::tests {

class FclWitness {
 public:
  /// Closed, facing outwards.
  FclWitness(const TriangleMesh& held, const TriangleMesh& environment);
  ~FclWitness();

  struct Opinion {
    bool surfaces_meet = false;  ///< some triangles of the two cross
    /// How deep the deepest point within kAround_m of such a crossing is in the other body; of
    /// bodies that do not meet 0, or infinite where one is inside the other. What is less than
    /// kNegligible_m is 0.
    double depth_m = 0.0;
  };
  static constexpr double kAround_m = 1e-3;
  /// From point to point, along edges, where depth is looked for; and the least that is looked at.
  static constexpr double kSpacing_m = 0.25e-3;
  static constexpr double kNegligible_m = 10e-6;

  /// @param X_EH the held mesh's frame in the environment's
  [[nodiscard]] Opinion at(const Pose& X_EH) const;

 private:
  struct Body;
  std::unique_ptr<const Body> held_;
  std::unique_ptr<const Body> environment_;
};

}  // namespace tenon::tests
