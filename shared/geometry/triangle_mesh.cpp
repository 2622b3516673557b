#include "shared/geometry/triangle_mesh.h"

#include <map>
#include <tuple>

namespace tenon {

TriangleMesh welded(const TriangleMesh& mesh) {
  TriangleMesh result;
  result.triangles.reserve(mesh.triangles.size());
  std::map<std::tuple<double, double, double>, std::uint32_t> known;
  for (const Triangle& triangle : mesh.triangles) {
    Triangle& now = result.triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3& point = mesh.points_m[triangle[i]];
      const auto next = static_cast<std::uint32_t>(result.points_m.size());
      const auto [at, fresh] = known.try_emplace({point.x(), point.y(), point.z()}, next);
      if (fresh) result.points_m.push_back(point);
      now[i] = at->second;
    }
  }
  return result;
}

}  // namespace tenon
