#include "sim/cell/virtual_arm/composite_inertia.h"

namespace tenon::sim {
namespace {

/// Of a point mass about the origin, per kg.
Eigen::Matrix3d of_point(const Vector3& at_m) {
  return at_m.squaredNorm() * Eigen::Matrix3d::Identity() - at_m * at_m.transpose();
}

}  // namespace

void CompositeInertia::add(double mass_kg, const Vector3& com_m,
                           const Eigen::Matrix3d& inertia_kgm2) {
  mass_kg_ += mass_kg;
  moment_kgm_ += mass_kg * com_m;
  about_origin_kgm2_ += inertia_kgm2 + mass_kg * of_point(com_m);
}

LinkInertia CompositeInertia::sum() const {
  const Vector3 com_m = moment_kgm_ / mass_kg_;
  return {mass_kg_, com_m, about_origin_kgm2_ - mass_kg_ * of_point(com_m)};
}

}  // namespace tenon::sim
