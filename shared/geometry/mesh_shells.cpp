#include "shared/geometry/mesh_shells.h"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace tenon {
namespace {

/// Which piece each point belongs to, by the lowest point that a search for roots ends at.
class Pieces {
 public:
  explicit Pieces(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  [[nodiscard]] std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

/// The part of the full sphere that a triangle covers, seen from a point (van Oosterom and
/// Strackee, "The solid angle of a plane triangle").
double covered(const std::array<Vector3, 3>& c, const Vector3& from_m) {
  const Vector3 a = c[0] - from_m;
  const Vector3 b = c[1] - from_m;
  const Vector3 d = c[2] - from_m;
  const double la = a.norm();
  const double lb = b.norm();
  const double ld = d.norm();
  const double across = a.dot(b.cross(d));
  const double along = la * lb * ld + a.dot(b) * ld + b.dot(d) * la + d.dot(a) * lb;
  return 2.0 * std::atan2(across, along) / (4.0 * std::numbers::pi);
}

}  // namespace

std::vector<Shell> shells_of(const TriangleMesh& mesh) {
  Pieces pieces(mesh.points_m.size());
  for (const Triangle& t : mesh.triangles) {
    pieces.join(t[0], t[1]);
    pieces.join(t[1], t[2]);
  }
  std::map<std::uint32_t, Shell> shells;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::array<Vector3, 3> c = mesh.corners_m(i);
    const std::uint32_t point = mesh.triangles[i][0];
    const auto [at, fresh] = shells.try_emplace(pieces.root(point));
    if (fresh) at->second.point = point;
    // About a point of the surface, so that its distance from the origin costs no digits.
    const Vector3& from_m = mesh.points_m[at->second.point];
    at->second.volume_m3 += (c[0] - from_m).dot((c[1] - from_m).cross(c[2] - from_m)) / 6.0;
  }
  std::vector<Shell> result;
  for (auto& [root, shell] : shells) {
    if (shells.size() > 1) {
      double around = 0.0;
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (pieces.root(mesh.triangles[i][0]) == root) continue;
        around += covered(mesh.corners_m(i), mesh.points_m[shell.point]);
      }
      shell.depth = static_cast<int>(std::lround(around));
    }
    result.push_back(shell);
  }
  return result;
}

std::optional<std::uint32_t> pinched_point(const TriangleMesh& mesh) {
  // A triangle's corners are joined across the edges that two triangles share; those of one point
  // must become one.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> corner_of;
  Pieces corners(3 * mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Triangle& t = mesh.triangles[i];
      corner_of[{t[j], t[(j + 1) % 3]}] = static_cast<std::uint32_t>(3 * i + j);
    }
  }
  for (const auto& [edge, corner] : corner_of) {
    const auto other = corner_of.find({edge.second, edge.first});
    if (other == corner_of.end()) continue;
    const std::uint32_t triangle = other->second / 3;
    corners.join(corner, 3 * triangle + (other->second % 3 + 1) % 3);
  }
  std::vector<std::int64_t> root_of(mesh.points_m.size(), -1);
  for (const auto& [edge, corner] : corner_of) {
    const auto root = static_cast<std::int64_t>(corners.root(corner));
    std::int64_t& known = root_of[edge.first];
    if (known >= 0 && known != root) return edge.first;
    known = root;
  }
  return std::nullopt;
}

}  // namespace tenon
