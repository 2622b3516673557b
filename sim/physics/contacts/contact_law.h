#pragma once
// How two surfaces meet. Plain data.

#include <algorithm>

namespace tenon::sim {

/// Dry friction, and a spring and damper along the normal. The stiffness is that of a whole face,
/// however many shapes it is made of: it is shared out among its contact points.
struct ContactLaw {
  double friction = 0.3;
  double stiffness_Npm = 5e4;
  double relaxation_s = 2e-3;  ///< damping over stiffness
};

/// Of a stiffness against pushes that parts and arm have in series, what the parts have: two that
/// meet are about as stiff as 1e6 N/m, and none comes far into the other. What gives way far more
/// is what holds them.
[[nodiscard]] inline double part_stiffness_Npm(double series_Npm) {
  constexpr double kPartStiffness_Npm = 1e6;
  return std::max(series_Npm, kPartStiffness_Npm);
}

/// What the arm gives way by in such a series; 0 where it is rigid.
[[nodiscard]] inline double arm_give_mpN(double series_Npm) {
  return 1.0 / series_Npm - 1.0 / part_stiffness_Npm(series_Npm);
}

}  // namespace tenon::sim
