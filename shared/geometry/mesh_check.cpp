#include "shared/geometry/mesh_check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <unordered_map>

#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/geometry/mesh_needles.h"
#include "shared/geometry/mesh_shells.h"
#include "shared/geometry/self_intersection.h"

namespace tenon {
namespace {

constexpr double kSizeMin_m = 1e-5;
constexpr double kSizeMax_m = 100.0;

std::string at(const Vector3& place_m) {
  return format("at (%.4f, %.4f, %.4f) mm", 1e3 * place_m.x(), 1e3 * place_m.y(),
                1e3 * place_m.z());
}

void check_points(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw InputError("has no triangle: export the part again");
  Vector3 low_m = mesh.points_m.front();
  Vector3 high_m = low_m;
  for (const Vector3& point_m : mesh.points_m) {
    if (!point_m.allFinite()) {
      throw InputError("a coordinate is not a finite number: export it again or lower scale");
    }
    low_m = low_m.cwiseMin(point_m);
    high_m = high_m.cwiseMax(point_m);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double size_m = high_m[axis] - low_m[axis];
    if (size_m >= kSizeMin_m) continue;
    throw InputError(format("measures %g m along %c, must be at least %g m: is scale too small?",
                            size_m, "xyz"[axis], kSizeMin_m));
  }
  const Vector3 furthest_m = low_m.cwiseAbs().cwiseMax(high_m.cwiseAbs());
  if (furthest_m.maxCoeff() <= kSizeMax_m) return;
  throw InputError(
      format("reaches %g m from its origin, must be at most %g m: is scale right? "
             "It is 0.001 where the file's unit is the millimetre",
             furthest_m.maxCoeff(), kSizeMax_m));
}

void check_triangles(const TriangleMesh& mesh) {
  std::size_t thin = 0;
  std::size_t first = 0;
  double least_m = kTriangleHeightMin_m;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const double height_m = tenon::height_m(mesh, mesh.triangles[i]);
    if (height_m >= kTriangleHeightMin_m) continue;
    if (thin++ == 0) first = i;
    least_m = std::min(least_m, height_m);
  }
  if (thin == 0) return;
  throw InputError(std::to_string(thin) + " of its triangles, number " + std::to_string(first) +
                   " first, " + at(mesh.corners_m(first)[0]) +
                   format(", are %.1e m high or less, must be at least %.0e m: merge points that "
                          "are the same, or is scale too small?",
                          least_m, kTriangleHeightMin_m));
}

struct Uses {
  std::uint32_t forth = 0;
  std::uint32_t back = 0;
};

/// Every edge once in each direction, or what is wrong with the first that is not.
void check_edges(const TriangleMesh& mesh) {
  std::unordered_map<std::uint64_t, Uses> edges;
  const auto uses = [&](std::uint32_t from, std::uint32_t to) -> Uses& {
    return edges[(static_cast<std::uint64_t>(std::min(from, to)) << 32U) | std::max(from, to)];
  };
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = t[i];
      const std::uint32_t to = t[(i + 1) % 3];
      ++(from < to ? uses(from, to).forth : uses(from, to).back);
    }
  }
  const auto refuse_if = [&](const auto& bad, const char* what, const char* todo) {
    std::size_t count = 0;
    Vector3 first_m;
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t from = t[i];
        const std::uint32_t to = t[(i + 1) % 3];
        if (!bad(uses(from, to))) continue;
        if (count++ == 0) first_m = 0.5 * (mesh.points_m[from] + mesh.points_m[to]);
      }
    }
    if (count == 0) return;
    throw InputError(std::to_string(count) + what + at(first_m) + todo);
  };
  refuse_if([](const Uses& u) { return u.forth + u.back > 2; },
            " edges of triangles are shared by more than two, the first ",
            ": the part must be one closed surface; remove doubled and inner faces");
  refuse_if([](const Uses& u) { return u.forth + u.back == 1; },
            " edges have a triangle on one side only, the first ",
            ": the surface is open; close its holes");
  refuse_if([](const Uses& u) { return u.forth != u.back; },
            " edges lie between triangles that face opposite ways, the first ",
            ": make all triangles face outwards");
}

}  // namespace

void check_mesh(const TriangleMesh& mesh) {
  check_points(mesh);
  check_triangles(mesh);
  check_edges(mesh);
  if (const auto pinch = pinched_point(mesh)) {
    throw InputError("two parts of its surface meet in the one point " + at(mesh.points_m[*pinch]) +
                     ": separate them");
  }
  if (const auto crossing = self_intersection(mesh)) {
    throw InputError(std::to_string(crossing->triangles) +
                     " of its triangles go through others, the first " + at(crossing->at_m) +
                     ": the part must not intersect itself; unite its bodies");
  }
  for (const Shell& shell : shells_of(mesh)) {
    const double volume_mm3 = 1e9 * shell.volume_m3;
    const std::string where = at(mesh.points_m[shell.point]);
    if (shell.volume_m3 <= 0.0 && shell.depth == 0) {
      throw InputError(format("is inside out, its volume %.4g mm3 ", volume_mm3) + where +
                       ": turn its triangles about");
    }
    if (shell.depth != (shell.volume_m3 > 0.0 ? 0 : 1)) {
      throw InputError(format("a shell of %.4g mm3 ", volume_mm3) + where +
                       " lies inside another one: remove it, or turn it about if it is a hollow");
    }
  }
}

}  // namespace tenon
