#include "shared/geometry/extrusion.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "shared/base/error.h"
#include "shared/base/text.h"

namespace tenon {
namespace {

using Point = Eigen::Vector2d;

// Corners and sides that are nearer to each other are one, or cross.
constexpr double kApart_m = 1e-7;

double cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }

double area_m2(const std::vector<Point>& p) {
  double twice_m2 = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) twice_m2 += cross(p[i], p[(i + 1) % p.size()]);
  return 0.5 * twice_m2;
}

double distance_m(const Point& point, const Point& from, const Point& to) {
  const Point along = to - from;
  const double part = std::clamp((point - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - from - part * along).norm();
}

bool meet(const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto side = [](const Point& from, const Point& to, const Point& p) {
    return cross(to - from, p - from) > 0.0;
  };
  if (side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)) return true;
  return std::min({distance_m(a, c, d), distance_m(b, c, d), distance_m(c, a, b),
                   distance_m(d, a, b)}) < kApart_m;
}

void check(const std::vector<Point>& p) {
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double side_m = (p[(i + 1) % n] - p[i]).norm();
    if (side_m < kApart_m) {
      throw InputError(
          format("corner %zu is %.1e m from the next, must be at least %.0e m: the "
                 "last corner does not repeat the first",
                 i, side_m, kApart_m));
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    const std::size_t after = (i + 2) % n;
    const Point way = p[after] - p[i];
    if (std::abs(cross(way, p[next] - p[i])) < kApart_m * way.norm()) {
      throw InputError(format("corner %zu lies on a line with its neighbours: leave it out", next));
    }
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (!meet(p[i], p[next], p[j], p[(j + 1) % n])) continue;
      throw InputError(
          format("the sides after corners %zu and %zu cross or touch: the outline "
                 "must not meet itself",
                 i, j));
    }
  }
}

/// Cuts off ears; leaves none where the outline is simple.
std::vector<Triangle> triangles_of(const std::vector<Point>& p) {
  std::vector<std::uint32_t> rest(p.size());
  std::iota(rest.begin(), rest.end(), 0U);
  std::vector<Triangle> triangles;
  while (rest.size() > 3) {
    // Of all ears the one that is the least sliver.
    std::size_t best = rest.size();
    double best_height_m = -1.0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const Triangle t = {rest[(i + rest.size() - 1) % rest.size()], rest[i],
                          rest[(i + 1) % rest.size()]};
      const double twice_m2 = cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
      const double height_m = twice_m2 / (p[t[2]] - p[t[0]]).norm();
      if (height_m <= best_height_m || twice_m2 <= 0.0) continue;
      const bool empty = std::none_of(rest.begin(), rest.end(), [&](std::uint32_t k) {
        if (k == t[0] || k == t[1] || k == t[2]) return false;
        for (std::size_t e = 0; e < 3; ++e) {
          const Point& from = p[t[e]];
          if (cross(p[t[(e + 1) % 3]] - from, p[k] - from) < 0.0) return false;
        }
        return true;
      });
      if (!empty) continue;
      best = i;
      best_height_m = height_m;
    }
    if (best == rest.size()) throw InputError("the outline cannot be filled with triangles");
    triangles.push_back(
        {rest[(best + rest.size() - 1) % rest.size()], rest[best], rest[(best + 1) % rest.size()]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
  }
  triangles.push_back({rest[0], rest[1], rest[2]});
  return triangles;
}

}  // namespace

TriangleMesh extruded(std::vector<Point> profile_m, double length_m) {
  check(profile_m);
  if (area_m2(profile_m) < 0.0) std::reverse(profile_m.begin(), profile_m.end());
  const auto n = static_cast<std::uint32_t>(profile_m.size());
  TriangleMesh mesh;
  for (const double z : {-0.5 * length_m, 0.5 * length_m}) {
    for (const Point& p : profile_m) mesh.points_m.emplace_back(p.x(), p.y(), z);
  }
  for (const Triangle& t : triangles_of(profile_m)) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    mesh.triangles.push_back({i, next, next + n});
    mesh.triangles.push_back({i, next + n, i + n});
  }
  return mesh;
}

}  // namespace tenon
