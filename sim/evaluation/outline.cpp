#include "sim/evaluation/outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace tenon::sim {
namespace {

/// Points whose convex hull is the shape.
std::vector<Vector3> corners_of(const Shape& shape, const Pose& frame) {
  constexpr int kRound = 32;
  const bool is_box = shape.kind == Shape::Kind::kBox;
  const int sides = is_box ? 4 : kRound;
  const double reach = is_box ? std::numbers::sqrt2 : 1.0;
  const Pose pose = compose(frame, shape.pose);
  std::vector<Vector3> corners;
  for (int side = 0; side < sides; ++side) {
    const double angle = 2.0 * std::numbers::pi * (side + 0.5) / sides;
    for (const double end : {-0.5, 0.5}) {
      const Vector3 local(0.5 * reach * std::cos(angle) * shape.size_m.x(),
                          0.5 * reach * std::sin(angle) * shape.size_m.y(), end * shape.size_m.z());
      corners.push_back(pose.position_m + pose.orientation * local);
    }
  }
  return corners;
}

double turn(const Point& a, const Point& b, const Point& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

/// Andrew's monotone chain.
std::vector<Point> hull_of(std::vector<Point> points) {
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  });
  std::vector<Point> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = hull.size();
    for (const Point& point : points) {
      while (hull.size() >= begin + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();  // begins the other half
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

std::pair<double, double> depth_of(const Shape& shape, const Pose& frame, const View& view) {
  std::pair<double, double> range{1e9, -1e9};
  for (const Vector3& corner : corners_of(shape, frame)) {
    range.first = std::min(range.first, corner[view.depth]);
    range.second = std::max(range.second, corner[view.depth]);
  }
  return range;
}

}  // namespace

std::vector<View> views_of(CoordinateMask coordinates) {
  const auto has = [coordinates](int axis) { return (coordinates >> axis & 1U) != 0; };
  constexpr View kAbove{0, 1, 2};
  constexpr View kFront{0, 2, 1};
  constexpr View kSide{1, 2, 0};
  if (!has(2)) return {kAbove};
  if (has(0) && has(1)) return {kAbove, kFront};
  return {has(1) ? kSide : kFront};
}

std::vector<Point> outline(const Shape& shape, const Pose& frame, const View& view) {
  std::vector<Point> points;
  for (const Vector3& corner : corners_of(shape, frame)) points.push_back(view(corner));
  return hull_of(std::move(points));
}

bool share_depth(const Shape& a, const Pose& frame_a, const Shape& b, const Pose& frame_b,
                 const View& view) {
  const auto [a_low, a_high] = depth_of(a, frame_a, view);
  const auto [b_low, b_high] = depth_of(b, frame_b, view);
  return a_low < b_high && b_low < a_high;
}

}  // namespace tenon::sim
