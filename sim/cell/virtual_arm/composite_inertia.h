#pragma once
// Rigid bodies that move as one: their mass, centre and inertia, summed in one frame.

#include "shared/cell/robot.h"
#include "shared/math/pose.h"

namespace tenon::sim {

class CompositeInertia {
 public:
  /// @param com_m, inertia_kgm2 (about the centre of mass): in the axes of the sum's frame
  void add(double mass_kg, const Vector3& com_m, const Eigen::Matrix3d& inertia_kgm2);

  /// As one body. The mass must not be 0.
  [[nodiscard]] LinkInertia sum() const;

 private:
  double mass_kg_ = 0.0;
  Vector3 moment_kgm_ = Vector3::Zero();  ///< mass times centre
  Eigen::Matrix3d about_origin_kgm2_ = Eigen::Matrix3d::Zero();
};

}  // namespace tenon::sim
