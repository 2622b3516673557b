#include "shared/drawing/silhouette.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

namespace tenon::drawing {
namespace {

// Faces seen at less than this angle, rad, are seen from their edge.
constexpr double kEdgeOn = 1e-9;

/// Lines from one node to another, put together to loops. As many begin at each node as end there.
template <typename Node>
Loops loops_of(std::multimap<Node, Node> lines, const std::map<Node, Point>& places_m) {
  Loops loops;
  while (!lines.empty()) {
    std::vector<Point>& loop = loops.emplace_back();
    auto line = lines.begin();
    const Node first = line->first;
    while (line != lines.end()) {
      loop.push_back(places_m.at(line->first));
      const Node next = line->second;
      lines.erase(line);
      line = next == first ? lines.end() : lines.find(next);
    }
  }
  return loops;
}

std::vector<Vector3> placed(const Solid& solid, const Pose& pose) {
  std::vector<Vector3> points_m;
  for (const Vector3& point_m : solid.mesh().points_m) {
    points_m.emplace_back(pose.position_m + pose.orientation * point_m);
  }
  return points_m;
}

}  // namespace

Loops shadow_of(const Solid& solid, const Pose& pose, const View& view) {
  const std::vector<Vector3> points_m = placed(solid, pose);
  std::map<std::uint32_t, Point> places_m;
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> rim;
  for (const Triangle& t : solid.mesh().triangles) {
    const Point a = view.m(points_m[t[0]]);
    const Point b = view.m(points_m[t[1]]);
    const Point c = view.m(points_m[t[2]]);
    const Vector3 across_m2 =
        (points_m[t[1]] - points_m[t[0]]).cross(points_m[t[2]] - points_m[t[0]]);
    const double seen_m2 = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
    if (seen_m2 <= kEdgeOn * across_m2.norm()) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      places_m[t[i]] = view.m(points_m[t[i]]);
      // An edge between two such faces is no rim.
      const std::uint32_t from = t[i];
      const std::uint32_t to = t[(i + 1) % 3];
      if (rim.erase({to, from}) == 0) rim[{from, to}] = true;
    }
  }
  std::multimap<std::uint32_t, std::uint32_t> lines;
  for (const auto& [edge, is_rim] : rim) lines.insert(edge);
  return loops_of(std::move(lines), places_m);
}

Loops section_of(const Solid& solid, const Pose& pose, const View& view, double depth_m) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  const std::vector<Vector3> points_m = placed(solid, pose);
  const auto above = [&](std::uint32_t point) { return points_m[point][view.along] >= depth_m; };
  std::map<Edge, Point> places_m;
  std::multimap<Edge, Edge> lines;
  for (const Triangle& t : solid.mesh().triangles) {
    // One edge goes up through the plane and one down, or none.
    Edge up;
    Edge down;
    int crossings = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = t[i];
      const std::uint32_t to = t[(i + 1) % 3];
      if (above(from) == above(to)) continue;
      const Edge edge = std::minmax(from, to);
      const Vector3& p = points_m[edge.first];
      const Vector3& q = points_m[edge.second];
      const double part = (depth_m - p[view.along]) / (q[view.along] - p[view.along]);
      places_m[edge] = view.m(p + part * (q - p));
      (above(to) ? up : down) = edge;
      ++crossings;
    }
    if (crossings == 2) lines.emplace(up, down);
  }
  return loops_of(std::move(lines), places_m);
}

}  // namespace tenon::drawing
