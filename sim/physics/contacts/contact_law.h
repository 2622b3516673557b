#pragma once
// How two surfaces meet. Plain data.

namespace tenon::sim {

/// Dry friction, and a spring and damper along the normal. The stiffness is that of a whole face,
/// however many shapes it is made of: it is shared out among its contact points.
struct ContactLaw {
  double friction = 0.3;
  double stiffness_Npm = 5e4;
  double relaxation_s = 2e-3;  ///< damping over stiffness
};

}  // namespace tenon::sim
