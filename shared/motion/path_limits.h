#pragma once
// What a displacement's speed limits are along its straight path. The path's unit is a metre of
// translation, or a radian where the displacement only rotates; where it does both, the tighter of
// the two limits holds. Real-time, pure.

#include <algorithm>

#include "shared/math/pose.h"
#include "shared/motion/move_parameters.h"

namespace tenon {

/// Less translation (m) or rotation (rad) is none.
inline constexpr double kNoTravel = 1e-9;

/// In path units; 0 for no motion.
[[nodiscard]] inline double path_length(const Vector6& displacement) {
  const double translation_m = displacement.head<3>().norm();
  if (translation_m > kNoTravel) return translation_m;
  const double rotation_rad = displacement.tail<3>().norm();
  return rotation_rad > kNoTravel ? rotation_rad : 0.0;
}

/// Path units, s.
struct PathLimits {
  double approach_speed = 0.0;
  double contact_speed = 0.0;
  double acceleration = 0.0;
  double jerk = 0.0;
};
[[nodiscard]] inline PathLimits path_limits(const Vector6& displacement, const SpeedLimits& v) {
  const double rotation_rad = displacement.tail<3>().norm();
  if (rotation_rad <= kNoTravel) {
    return {v.approach_mps, v.contact_mps, v.acceleration_mps2, v.jerk_mps3};
  }
  const bool turn_only = displacement.head<3>().norm() <= kNoTravel;
  const double path_per_rad = path_length(displacement) / rotation_rad;
  const auto limit = [&](double linear, double angular) {
    return turn_only ? angular : std::min(linear, angular * path_per_rad);
  };
  return {limit(v.approach_mps, v.approach_radps), limit(v.contact_mps, v.contact_radps),
          limit(v.acceleration_mps2, v.acceleration_radps2), limit(v.jerk_mps3, v.jerk_radps3)};
}

}  // namespace tenon
