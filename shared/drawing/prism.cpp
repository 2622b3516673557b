#include "shared/drawing/prism.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "shared/geometry/solid.h"

namespace tenon::drawing {
namespace {

bool turns_left(const Point& a, const Point& b, const Point& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x() > 0.0;
}

/// All of its points: their hull is what counts.
Prism hull_points(const Shape& shape, const Pose& frame) {
  const Pose pose = compose(frame, shape.pose);
  Prism prism;
  for (const Vector3& point_m : shape.solid->mesh().points_m) {
    prism.corners_m.emplace_back(pose.position_m + pose.orientation * point_m);
  }
  return prism;
}

}  // namespace

Prism prism_of(const Shape& shape, const Pose& frame, int round_sides) {
  if (shape.solid) return hull_points(shape, frame);
  const bool box = shape.kind == Shape::Kind::kBox;
  const int sides = box ? 4 : round_sides;
  const double reach = box ? std::numbers::sqrt2 : 1.0;
  const Pose pose = compose(frame, shape.pose);
  Prism prism;
  for (const double end : {-0.5, 0.5}) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 2.0 * std::numbers::pi * (i + 0.5) / sides;
      const Vector3 local(0.5 * reach * std::cos(angle) * shape.size_m.x(),
                          0.5 * reach * std::sin(angle) * shape.size_m.y(), end * shape.size_m.z());
      prism.corners_m.push_back(pose.position_m + pose.orientation * local);
    }
  }
  return prism;
}

std::vector<Point> hull_of(std::vector<Point> points) {
  if (points.size() < 3) return points;
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  });
  std::vector<Point> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t first = hull.size();
    for (const Point& point : points) {
      while (hull.size() >= first + 2 && !turns_left(hull[hull.size() - 2], hull.back(), point)) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();  // begins the other half
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

}  // namespace tenon::drawing
