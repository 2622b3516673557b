#pragma once
// How far two bodies are in each other, seen from an edge of the one that lies on the surface of
// the other. Pure.

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
/// @return no more than the way that parts them; 0 where no place was found inside of both
template <typename Own, typename Other>
[[nodiscard]] double common_depth_m(const Vector3& at_m, const Vector3& inwards, const Own& own_m,
                                    const Other& other_m) {
  double deepest_m = 0.0;
  for (double way_m = kDrawnTo_m;; way_m *= 2.0) {
    const Vector3 point_m = at_m + way_m * inwards;
    const double in_other_m = -other_m(point_m);
    if (in_other_m < 0.0) return deepest_m;
    const double in_own_m = -own_m(point_m);
    if (in_own_m < 0.0 || in_own_m + in_other_m <= deepest_m) return deepest_m;
    deepest_m = in_own_m + in_other_m;
  }
}

}  // namespace tenon
