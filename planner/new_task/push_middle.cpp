#include "planner/new_task/push_middle.h"

#include <algorithm>
#include <vector>

namespace tenon::planner {
namespace {

// A face that is no more askew than this lies on the wall as a whole.
constexpr double kOnWall_m = 20e-6;

using Points = std::vector<Eigen::Vector2d>;

/// Where the surface's edges go through a height.
Points cut(const TriangleMesh& part, double z_m) {
  Points points;
  for (const Triangle& triangle : part.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3& a = part.points_m[triangle[i]];
      const Vector3& b = part.points_m[triangle[(i + 1) % 3]];
      if ((a.z() > z_m) == (b.z() > z_m)) continue;
      const Vector3 at = a + (z_m - a.z()) / (b.z() - a.z()) * (b - a);
      points.emplace_back(at.head<2>());
    }
  }
  return points;
}

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Across a push along an axis: how far what meets a wall first reaches.
Interval ahead(const Points& points, int axis, int sign) {
  const auto reach = [&](const Eigen::Vector2d& p) { return sign * p[axis]; };
  double most = reach(points.front());
  for (const Eigen::Vector2d& p : points) most = std::max(most, reach(p));
  Interval across{1e9, -1e9};
  for (const Eigen::Vector2d& p : points) {
    if (reach(p) < most - kOnWall_m) continue;
    across.low = std::min(across.low, p[1 - axis]);
    across.high = std::max(across.high, p[1 - axis]);
  }
  return across;
}

}  // namespace

std::optional<Eigen::Vector2d> push_middle_m(const TriangleMesh& part, double z_m) {
  const Points points = cut(part, z_m);
  if (points.empty()) return std::nullopt;
  Eigen::Vector2d middle;
  for (int axis = 0; axis < 2; ++axis) {
    const Interval up = ahead(points, axis, 1);
    const Interval down = ahead(points, axis, -1);
    // Amid what they have in common; where that is nothing, amid the gap.
    middle[1 - axis] = 0.5 * (std::max(up.low, down.low) + std::min(up.high, down.high));
  }
  return middle;
}

}  // namespace tenon::planner
