#pragma once
// A box or a cylinder as an outline that is drawn out along an axis. Private to sim; plain data.

#include "shared/math/pose.h"

namespace tenon::sim {

/// All vectors are of the world. The outline is a rectangle of 2 half_u by 2 half_v, or a circle.
struct Prism {
  Vector3 centre_m;
  Vector3 axis;
  double half_length_m = 0.0;
  Vector3 u;
  Vector3 v;
  double half_u_m = 0.0;  ///< a circle's radius
  double half_v_m = 0.0;
  bool round = false;
};

}  // namespace tenon::sim
