#pragma once
// Poses, displacements and wrenches. SI units. Frames are named at the use, X_AB is B in A.

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tenon {

using Vector3 = Eigen::Vector3d;
/// Translation first, then rotation: [m, rad], [m/s, rad/s], [N, Nm].
using Vector6 = Eigen::Matrix<double, 6, 1>;

struct Pose {
  Vector3 position_m = Vector3::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();

  friend bool operator==(const Pose& a, const Pose& b) {
    return a.position_m == b.position_m && a.orientation.coeffs() == b.orientation.coeffs();
  }
};

/// X_AC = X_AB X_BC.
[[nodiscard]] Pose compose(const Pose& X_AB, const Pose& X_BC);

/// X_BA of X_AB.
[[nodiscard]] Pose inverse(const Pose& X_AB);

/// Rotation vector (axis times angle, rad, norm at most pi) of a unit quaternion. The sign of the
/// quaternion does not matter.
[[nodiscard]] Vector3 rotation_vector(const Eigen::Quaterniond& rotation);

/// Unit quaternion of a rotation vector (rad).
[[nodiscard]] Eigen::Quaterniond rotation_of(const Vector3& rotation_vector_rad);

/// The displacement that takes `from` to `to`: translation and rotation vector, both in the axes of
/// the frame that the poses are given in (the rotation multiplies from the left).
[[nodiscard]] inline Vector6 displacement_between(const Pose& from, const Pose& to) {
  Vector6 displacement;
  displacement.head<3>() = to.position_m - from.position_m;
  if (to.orientation.coeffs() == from.orientation.coeffs()) {
    displacement.tail<3>().setZero();
  } else {
    displacement.tail<3>() = rotation_vector(to.orientation * from.orientation.conjugate());
  }
  return displacement;
}

/// `pose` moved by a displacement as displacement_between() gives it.
[[nodiscard]] inline Pose displaced(const Pose& pose, const Vector6& displacement) {
  const Vector3 turn_rad = displacement.tail<3>();
  if (turn_rad.isZero(0.0)) return {pose.position_m + displacement.head<3>(), pose.orientation};
  return {pose.position_m + displacement.head<3>(),
          (rotation_of(turn_rad) * pose.orientation).normalized()};
}

}  // namespace tenon
