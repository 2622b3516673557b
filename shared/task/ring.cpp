#include "shared/task/ring.h"

#include <cmath>
#include <numbers>

namespace tenon {

std::vector<Shape> boxes_of(const Ring& ring) {
  const double turn_rad = 2.0 * std::numbers::pi / ring.segments;
  const double wall_m = 0.5 * (ring.outer_diameter_m - ring.inner_diameter_m);
  const double radius_m = 0.25 * (ring.outer_diameter_m + ring.inner_diameter_m);
  // As wide as a side of the outer polygon: neighbours overlap, and reach into the hole nowhere.
  const double width_m = ring.outer_diameter_m * std::tan(0.5 * turn_rad);
  std::vector<Shape> boxes;
  for (int i = 0; i < ring.segments; ++i) {
    const Eigen::Quaterniond towards = rotation_of({0.0, 0.0, i * turn_rad});
    const Pose in_ring = {towards * Vector3(radius_m, 0.0, 0.0), towards};
    boxes.push_back({ring.name + "[" + std::to_string(i) + "]",
                     Shape::Kind::kBox,
                     {wall_m, width_m, ring.length_m},
                     compose(ring.pose, in_ring)});
  }
  return boxes;
}

std::string piece_of(const std::string& shape_name) {
  const std::size_t bracket = shape_name.find('[');
  return bracket == 0 ? shape_name : shape_name.substr(0, bracket);
}

}  // namespace tenon
