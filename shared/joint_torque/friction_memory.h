#pragma once
// Dry friction goes by the way and remembers it: it comes to its full value in the direction of a
// motion within some way, and where the joint rests it stays as it was. Fit for real time.

#include <cmath>

namespace tenon {

/// z in [-1, 1], share of the Coulomb friction that acts.
/// @param moved since z was so, in one direction  @param way within which z turns by 1 - 1/e
[[nodiscard]] inline double friction_after(double z, double moved, double way) {
  if (moved == 0.0) return z;
  const double direction = moved > 0.0 ? 1.0 : -1.0;
  return direction + (z - direction) * std::exp(-std::abs(moved) / way);
}

}  // namespace tenon
