#include "shared/math/pose.h"

#include <cmath>

namespace tenon {

Pose compose(const Pose& X_AB, const Pose& X_BC) {
  return {X_AB.position_m + X_AB.orientation * X_BC.position_m,
          (X_AB.orientation * X_BC.orientation).normalized()};
}

Pose inverse(const Pose& X_AB) {
  const Eigen::Quaterniond back = X_AB.orientation.conjugate();
  return {-(back * X_AB.position_m), back};
}

Vector3 rotation_vector(const Eigen::Quaterniond& rotation) {
  const Vector3 imaginary = rotation.w() < 0.0 ? Vector3(-rotation.vec()) : Vector3(rotation.vec());
  const double sine = imaginary.norm();
  // Below this the half-angle's sine and the half-angle agree to the last bit.
  constexpr double kSmallSine = 1e-9;
  if (sine < kSmallSine) return 2.0 * imaginary;
  return (2.0 * std::atan2(sine, std::abs(rotation.w())) / sine) * imaginary;
}

Eigen::Quaterniond rotation_of(const Vector3& rotation_vector_rad) {
  const double angle_rad = rotation_vector_rad.norm();
  if (angle_rad == 0.0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, rotation_vector_rad / angle_rad));
}

}  // namespace tenon
