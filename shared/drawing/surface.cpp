#include "shared/drawing/surface.h"

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "shared/drawing/prism.h"
#include "shared/geometry/solid.h"

namespace tenon::drawing {
namespace {

using Cell = std::array<std::int64_t, 3>;

/// Of a grid with cells of that size.
TriangleMesh clustered(const TriangleMesh& mesh, double cell_m) {
  std::map<Cell, std::uint32_t> numbers;
  std::vector<std::uint32_t> cluster_of;
  std::vector<double> counts;
  TriangleMesh coarse;
  for (const Vector3& point_m : mesh.points_m) {
    const Eigen::Array3d at = (point_m / cell_m).array().floor();
    const Cell cell = {static_cast<std::int64_t>(at.x()), static_cast<std::int64_t>(at.y()),
                       static_cast<std::int64_t>(at.z())};
    const auto [entry, fresh] =
        numbers.try_emplace(cell, static_cast<std::uint32_t>(numbers.size()));
    if (fresh) {
      coarse.points_m.emplace_back(Vector3::Zero());
      counts.push_back(0.0);
    }
    coarse.points_m[entry->second] += point_m;
    counts[entry->second] += 1.0;
    cluster_of.push_back(entry->second);
  }
  for (std::size_t i = 0; i < counts.size(); ++i) coarse.points_m[i] /= counts[i];
  for (const Triangle& t : mesh.triangles) {
    const Triangle kept = {cluster_of[t[0]], cluster_of[t[1]], cluster_of[t[2]]};
    if (kept[0] != kept[1] && kept[1] != kept[2] && kept[2] != kept[0]) {
      coarse.triangles.push_back(kept);
    }
  }
  return coarse;
}

TriangleMesh mesh_of(Prism prism) {
  const auto sides = static_cast<std::uint32_t>(prism.sides());
  TriangleMesh mesh;
  mesh.points_m = std::move(prism.corners_m);
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t next = (i + 1) % sides;
    mesh.triangles.push_back({i, next, sides + next});
    mesh.triangles.push_back({i, sides + next, sides + i});
    if (i == 0 || next == 0) continue;
    mesh.triangles.push_back({0, next, i});
    mesh.triangles.push_back({sides, sides + i, sides + next});
  }
  return mesh;
}

}  // namespace

TriangleMesh decimated(const TriangleMesh& mesh, std::size_t triangles_max) {
  if (mesh.triangles.size() <= triangles_max) return mesh;
  Vector3 low = mesh.points_m.front();
  Vector3 high = low;
  for (const Vector3& point_m : mesh.points_m) {
    low = low.cwiseMin(point_m);
    high = high.cwiseMax(point_m);
  }
  // A cell as large as the mesh leaves at most eight points, one twice as large at most eight
  // more coarsely; the finest grid that is coarse enough lies between nothing and that.
  double fine_m = 0.0;
  double coarse_m = (high - low).maxCoeff();
  TriangleMesh best = clustered(mesh, coarse_m);
  constexpr int kHalvings = 16;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle_m = 0.5 * (fine_m + coarse_m);
    TriangleMesh tried = clustered(mesh, middle_m);
    if (tried.triangles.size() <= triangles_max) {
      coarse_m = middle_m;
      best = std::move(tried);
    } else {
      fine_m = middle_m;
    }
  }
  if (best.triangles.size() > triangles_max) best.triangles.resize(triangles_max);
  return best;
}

TriangleMesh surface_of(const Shape& shape, int round_sides, std::size_t triangles_max) {
  if (!shape.solid) return mesh_of(prism_of(shape, Pose{}, round_sides));
  TriangleMesh mesh = decimated(shape.solid->mesh(), triangles_max);
  for (Vector3& point_m : mesh.points_m) {
    point_m = shape.pose.position_m + shape.pose.orientation * point_m;
  }
  return mesh;
}

}  // namespace tenon::drawing
