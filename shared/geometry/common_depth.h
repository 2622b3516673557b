#pragma once
// How far two bodies are in each other, seen from an edge of the one that lies on the surface of
// the other. Pure.

#include <algorithm>

#include "shared/math/pose.h"

namespace tenon {

/// Shapes that touch are drawn to about this.
inline constexpr double kDrawnTo_m = 1e-6;

/// Wherever a place is inside of both, they are at least so far in each other as the sum of its
/// depths: a ball around it in the one has to leave a ball in the other. From the edge inwards the
/// sum grows until it is what the faces overlap by.
/// @param at_m on an edge of the one, not at its ends
/// @param inwards as Solid::Edge::inwards
/// @param own_m, other_m distances of a point from either surface, negative inside
/// @param known_m what is no more than this need not be found
/// @return no more than the way that parts them; `known_m` where no place was found that says more
template <typename Own, typename Other>
[[nodiscard]] double common_depth_m(const Vector3& at_m, const Vector3& inwards, const Own& own_m,
                                    const Other& other_m, double known_m = 0.0) {
  const double length = inwards.norm();
  double deepest_m = 0.0;
  for (double way_m = kDrawnTo_m;; way_m *= 2.0) {
    const Vector3 point_m = at_m + way_m * inwards;
    const double in_other_m = -other_m(point_m);
    if (in_other_m < 0.0) break;
    if (way_m * length + in_other_m <= known_m) continue;  // no deeper in the one than the way
    const double in_own_m = -own_m(point_m);
    if (in_own_m < 0.0 || in_own_m + in_other_m <= deepest_m) break;
    deepest_m = in_own_m + in_other_m;
  }
  return std::max(known_m, deepest_m);
}

}  // namespace tenon
