#pragma once
// Round holes, made of boxes.

#include <string>
#include <vector>

#include "shared/math/pose.h"
#include "shared/task/task.h"

namespace tenon {

struct Ring {
  std::string name;
  double inner_diameter_m = 0.0;
  double outer_diameter_m = 0.0;
  double length_m = 0.0;  ///< along its z
  int segments = 16;
  Pose pose;  ///< of its centre
};

/// One box a segment, named NAME[0], NAME[1] and on, their inner faces tangent to the inner circle
/// and their outer faces to the outer one; the first faces the ring's +x. Together they fill the
/// space between two regular polygons, without a gap.
///
/// The hole is never narrower than the circle, and wider by the factor 1 / cos(pi / segments) at
/// the polygon's corners: 1.96 % for 16 segments, 0.48 % for 32. The same factor holds for the way
/// that a round peg has in the hole: a clearance of 1 mm is 1.02 mm towards a corner.
[[nodiscard]] std::vector<Shape> boxes_of(const Ring& ring);

/// "hole" of "hole[12]": what people call a shape whose pieces have its name and a number each.
[[nodiscard]] std::string piece_of(const std::string& shape_name);

}  // namespace tenon
