#pragma once
// Where a shape can be pushed against: geometry alone, nothing simulates. Pure; any thread.

#include <Eigen/Geometry>
#include <vector>

#include "shared/task/task.h"

namespace tenon::planner {

/// A flat side of a shape that faces against a push along an axis of the task.
struct TouchPlace {
  Vector3 at_m;                ///< on the side, task frame
  double area_m2 = 0.0;        ///< of the side
  double to_rim_m = 0.0;       ///< from there to where the side ends
  Eigen::AlignedBox3d side_m;  ///< around the side, task frame
};

/// A side of a box or a cylinder as far as its corners reach; of a solid its largest flat
/// patches and the largest of those that nothing of it stands before, the largest first. The place
/// on a patch is where its rim is far: of all that are farther from it than `enough_m` the one
/// nearest to `near_m`, else the farthest.
/// @param axis 0..2 of the push  @param sign +1 or -1, its direction
[[nodiscard]] std::vector<TouchPlace> touch_places(const Shape& shape, int axis, int sign,
                                                   double enough_m, const Vector3& near_m);

/// Outer sides of a solid that are round, such as a cylinder's, at most two, the largest first: the
/// place is where the rim of what slopes by no more than 25 degrees is farthest, as far ahead as
/// the push meets the side first. None of other shapes.
[[nodiscard]] std::vector<TouchPlace> round_places(const Shape& shape, int axis, int sign,
                                                   const Vector3& near_m);

}  // namespace tenon::planner
