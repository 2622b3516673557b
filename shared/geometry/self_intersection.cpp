#include "shared/geometry/self_intersection.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "shared/geometry/mesh_needles.h"
#include "shared/geometry/triangle_tree.h"

namespace tenon {
namespace {

// Deeper than what rounding a file to six decimals makes of faces that touch.
constexpr double kThrough_m = 1e-6;
// The sine of the angle between two faces that lie on each other.
constexpr double kFolded = 1e-6;

bool has_corner(const Triangle& triangle, std::uint32_t point) {
  return std::find(triangle.begin(), triangle.end(), point) != triangle.end();
}

/// Where a segment goes through the inside of a triangle.
std::optional<Vector3> passage(const Vector3& from_m, const Vector3& to_m,
                               const std::array<Vector3, 3>& c) {
  const Vector3 normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
  const double above_m = normal.dot(from_m - c[0]);
  const double below_m = normal.dot(to_m - c[0]);
  if (std::min(above_m, below_m) > -kThrough_m || std::max(above_m, below_m) < kThrough_m) {
    return std::nullopt;
  }
  const Vector3 at_m = from_m + above_m / (above_m - below_m) * (to_m - from_m);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 along = (c[(i + 1) % 3] - c[i]).normalized();
    if (normal.cross(along).dot(at_m - c[i]) < kThrough_m) return std::nullopt;
  }
  return at_m;
}

/// Two triangles at an edge, one on the other.
bool folded(const std::array<Vector3, 3>& a, const std::array<Vector3, 3>& b) {
  const Vector3 normal_a = (a[1] - a[0]).cross(a[2] - a[0]).normalized();
  const Vector3 normal_b = (b[1] - b[0]).cross(b[2] - b[0]).normalized();
  return normal_a.dot(normal_b) < 0.0 && normal_a.cross(normal_b).norm() < kFolded;
}

std::optional<Vector3> meeting(const TriangleMesh& mesh, std::uint32_t i, std::uint32_t j) {
  const Triangle& t = mesh.triangles[i];
  const Triangle& other = mesh.triangles[j];
  const std::array<Vector3, 3> c = mesh.corners_m(j);
  const auto shared = std::count_if(t.begin(), t.end(),
                                    [&](std::uint32_t point) { return has_corner(other, point); });
  if (shared >= 2) {
    const bool thin = std::min(height_m(mesh, t), height_m(mesh, other)) < kSliver_m;
    if (!thin && folded(mesh.corners_m(i), c)) return Vector3((c[0] + c[1] + c[2]) / 3.0);
    return std::nullopt;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t from = t[k];
    const std::uint32_t to = t[(k + 1) % 3];
    if (has_corner(other, from) || has_corner(other, to)) continue;
    if (auto at_m = passage(mesh.points_m[from], mesh.points_m[to], c)) return at_m;
  }
  return std::nullopt;
}

}  // namespace

std::optional<SelfIntersection> self_intersection(const TriangleMesh& mesh) {
  const TriangleTree tree(mesh);
  SelfIntersection found;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    Eigen::AlignedBox3d box;
    for (const Vector3& corner_m : mesh.corners_m(i)) box.extend(corner_m);
    bool through = false;
    tree.near_box(box, [&](std::uint32_t j) {
      if (through || j == i) return;
      const auto at_m = meeting(mesh, i, j);
      if (!at_m) return;
      through = true;
      if (found.triangles++ == 0) found.at_m = *at_m;
    });
  }
  if (found.triangles == 0) return std::nullopt;
  return found;
}

}  // namespace tenon
