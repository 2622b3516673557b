#include "shared/geometry/mesh_needles.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tenon {
namespace {

std::array<double, 3> edges_m(const TriangleMesh& mesh, const Triangle& triangle) {
  std::array<double, 3> lengths_m{};
  for (std::size_t i = 0; i < 3; ++i) {
    lengths_m[i] = (mesh.points_m[triangle[(i + 1) % 3]] - mesh.points_m[triangle[i]]).norm();
  }
  return lengths_m;
}

bool has_area(const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

/// The ends of the shortest edges of needles become one point, where they are so close.
void join_corners(TriangleMesh& mesh, const std::vector<std::size_t>& needles) {
  std::vector<std::uint32_t> becomes(mesh.points_m.size());
  std::iota(becomes.begin(), becomes.end(), 0U);
  const auto last = [&](std::uint32_t point) {
    while (becomes[point] != point) point = becomes[point];
    return point;
  };
  for (const std::size_t needle : needles) {
    const Triangle& t = mesh.triangles[needle];
    const std::array<double, 3> lengths_m = edges_m(mesh, t);
    for (std::size_t i = 0; i < 3; ++i) {
      if (lengths_m[i] >= kTriangleHeightMin_m) continue;
      const std::uint32_t one = last(t[i]);
      const std::uint32_t other = last(t[(i + 1) % 3]);
      becomes[std::max(one, other)] = std::min(one, other);
    }
  }
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& corner : t) corner = last(corner);
  }
  std::erase_if(mesh.triangles, [](const Triangle& t) { return !has_area(t); });
}

/// Triangles by their directed edges.
class Neighbours {
 public:
  explicit Neighbours(const TriangleMesh& mesh) : mesh_(mesh) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) add(i);
  }
  void add(std::size_t triangle) {
    const Triangle& t = mesh_.triangles[triangle];
    for (std::size_t i = 0; i < 3; ++i) of_[key(t[i], t[(i + 1) % 3])] = triangle;
  }
  void drop_edge(std::uint32_t a, std::uint32_t b) {
    of_.erase(key(a, b));
    of_.erase(key(b, a));
  }
  [[nodiscard]] std::optional<std::size_t> with_edge(std::uint32_t from, std::uint32_t to) const {
    const auto found = of_.find(key(from, to));
    return found == of_.end() ? std::nullopt : std::optional(found->second);
  }
  /// The corner beyond an edge.
  [[nodiscard]] std::optional<std::uint32_t> corner(std::uint32_t from, std::uint32_t to) const {
    const auto triangle = with_edge(from, to);
    if (!triangle) return std::nullopt;
    const Triangle& t = mesh_.triangles[*triangle];
    return *std::find_if(t.begin(), t.end(), [&](std::uint32_t c) { return c != from && c != to; });
  }

 private:
  static std::uint64_t key(std::uint32_t from, std::uint32_t to) {
    return (static_cast<std::uint64_t>(from) << 32U) | to;
  }
  const TriangleMesh& mesh_;
  std::unordered_map<std::uint64_t, std::size_t> of_;
};

/// A triangle's longest edge, from a to b, its other corner c, and what lies beyond.
struct Longest {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t c = 0;
  std::optional<std::size_t> beyond;
};

Longest longest_of(const TriangleMesh& mesh, std::size_t triangle, const Neighbours& neighbours) {
  const Triangle& t = mesh.triangles[triangle];
  const std::array<double, 3> lengths_m = edges_m(mesh, t);
  const auto i = static_cast<std::size_t>(std::max_element(lengths_m.begin(), lengths_m.end()) -
                                          lengths_m.begin());
  const std::uint32_t a = t[i];
  const std::uint32_t b = t[(i + 1) % 3];
  return {a, b, t[(i + 2) % 3], neighbours.with_edge(b, a)};
}

bool is_needle(const TriangleMesh& mesh, std::size_t triangle) {
  return height_m(mesh, mesh.triangles[triangle]) < kTriangleHeightMin_m;
}

std::vector<std::size_t> needles_of(const TriangleMesh& mesh) {
  std::vector<std::size_t> needles;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (is_needle(mesh, i)) needles.push_back(i);
  }
  return needles;
}

/// The needle's longest edge gives way to one from its other corner to that of the triangle beyond.
/// @return false where it may not: that edge stands elsewhere already
bool flip(TriangleMesh& mesh, std::size_t needle, const Longest& longest, Neighbours& neighbours) {
  const auto [a, b, c, beyond] = longest;
  const std::uint32_t d = *neighbours.corner(b, a);
  const bool taken = neighbours.with_edge(c, d) || neighbours.with_edge(d, c);
  // Of a corner with three triangles two will be each other's back, and go.
  const bool closes = neighbours.corner(c, b) == d || neighbours.corner(a, c) == d;
  if (c == d || (taken && !closes)) return false;
  mesh.triangles[needle] = {a, d, c};
  mesh.triangles[*beyond] = {d, b, c};
  neighbours.drop_edge(a, b);
  neighbours.add(needle);
  neighbours.add(*beyond);
  return true;
}

/// Flips what it can. @param also_two beside another needle too  @return whether there was any
bool flip_all(TriangleMesh& mesh, bool also_two) {
  Neighbours neighbours(mesh);
  bool any = false;
  for (const std::size_t needle : needles_of(mesh)) {
    if (!is_needle(mesh, needle)) continue;
    const Longest longest = longest_of(mesh, needle, neighbours);
    if (!longest.beyond || (!also_two && is_needle(mesh, *longest.beyond))) continue;
    any = flip(mesh, needle, longest, neighbours) || any;
  }
  return any;
}

/// Pairs of triangles that are each other's back enclose nothing.
void drop_pairs(TriangleMesh& mesh) {
  std::map<Triangle, std::vector<std::size_t>> by_corners;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Triangle corners = mesh.triangles[i];
    std::sort(corners.begin(), corners.end());
    by_corners[corners].push_back(i);
  }
  std::vector<bool> gone(mesh.triangles.size(), false);
  for (const auto& [corners, all] : by_corners) {
    if (all.size() != 2) continue;
    const Triangle& one = mesh.triangles[all[0]];
    const Triangle& other = mesh.triangles[all[1]];
    const auto at = std::find(other.begin(), other.end(), one[0]) - other.begin();
    const bool same_way = other[static_cast<std::size_t>(at + 1) % 3] == one[1];
    if (!same_way) gone[all[0]] = gone[all[1]] = true;
  }
  std::size_t i = 0;
  std::erase_if(mesh.triangles, [&](const Triangle&) { return gone[i++]; });
}

}  // namespace

double height_m(const TriangleMesh& mesh, const Triangle& triangle) {
  const std::array<double, 3> lengths_m = edges_m(mesh, triangle);
  const double longest_m = *std::max_element(lengths_m.begin(), lengths_m.end());
  if (longest_m == 0.0) return 0.0;
  const Vector3& at_m = mesh.points_m[triangle[0]];
  const Vector3 twice_m2 =
      (mesh.points_m[triangle[1]] - at_m).cross(mesh.points_m[triangle[2]] - at_m);
  return twice_m2.norm() / longest_m;
}

TriangleMesh without_needles(const TriangleMesh& mesh) {
  const std::vector<std::size_t> needles = needles_of(mesh);
  if (needles.empty() || 2 * needles.size() > mesh.triangles.size()) return mesh;
  TriangleMesh mended = mesh;
  join_corners(mended, needles);
  // So many corners lie on one edge at most: each round takes one.
  constexpr int kRounds = 100;
  for (int i = 0; i < kRounds; ++i) {
    drop_pairs(mended);
    if (!flip_all(mended, false) && !flip_all(mended, true)) break;
  }
  drop_pairs(mended);
  return mended;
}

}  // namespace tenon
