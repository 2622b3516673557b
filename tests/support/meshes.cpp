#include "tests/support/meshes.h"

#include <cstring>
#include <numbers>

namespace tenon::tests {
namespace {

void put(std::string& bytes, const void* data, std::size_t size) {
  bytes.append(static_cast<const char*>(data), size);
}

void put(std::string& bytes, const Vector3& point_m, double unit_m) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto value = static_cast<float>(point_m[axis] / unit_m);
    put(bytes, &value, sizeof value);
  }
}

std::string words(const Vector3& point_m, double unit_m) {
  char text[100];
  std::snprintf(text, sizeof text, "%.9g %.9g %.9g\n", point_m.x() / unit_m, point_m.y() / unit_m,
                point_m.z() / unit_m);
  return text;
}

}  // namespace

TriangleMesh box_mesh(const Vector3& size_m, const Vector3& centre_m) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Vector3 sign((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5,
                       (i & 4) != 0 ? 0.5 : -0.5);
    mesh.points_m.emplace_back(centre_m + size_m.cwiseProduct(sign));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

Profile round_profile(double radius_m, int corners) {
  Profile profile;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    profile.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle));
  }
  return profile;
}

TriangleMesh together(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both = a;
  const auto first = static_cast<std::uint32_t>(a.points_m.size());
  both.points_m.insert(both.points_m.end(), b.points_m.begin(), b.points_m.end());
  for (const Triangle& t : b.triangles) {
    both.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return both;
}

TriangleMesh turned_about(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  return mesh;
}

TriangleMesh lofted(const std::vector<Ring3>& rings) {
  TriangleMesh mesh;
  const auto n = static_cast<std::uint32_t>(rings.front().profile_m.size());
  for (const Ring3& ring : rings) {
    for (const Eigen::Vector2d& p : ring.profile_m)
      mesh.points_m.emplace_back(p.x(), p.y(), ring.z_m);
  }
  const auto add_middle = [&](const Ring3& ring) {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : ring.profile_m) middle += p / static_cast<double>(n);
    mesh.points_m.emplace_back(middle.x(), middle.y(), ring.z_m);
    return static_cast<std::uint32_t>(mesh.points_m.size() - 1);
  };
  const std::uint32_t first = add_middle(rings.front());
  const std::uint32_t last = add_middle(rings.back());
  const auto top = static_cast<std::uint32_t>(n * (rings.size() - 1));
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    mesh.triangles.push_back({first, next, i});
    mesh.triangles.push_back({last, top + i, top + next});
    for (std::uint32_t below = 0; below < top; below += n) {
      mesh.triangles.push_back({below + i, below + next, below + n + next});
      mesh.triangles.push_back({below + i, below + n + next, below + n + i});
    }
  }
  return mesh;
}

std::string binary_stl(const TriangleMesh& mesh, double unit_m) {
  std::string bytes(80, '\0');
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  put(bytes, &count, sizeof count);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto c = mesh.corners_m(i);
    put(bytes, (c[1] - c[0]).cross(c[2] - c[0]).normalized(), 1.0);
    for (const Vector3& corner_m : c) put(bytes, corner_m, unit_m);
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string ascii_stl(const TriangleMesh& mesh, double unit_m) {
  std::string text = "solid part\n";
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const Vector3& corner_m : mesh.corners_m(i)) text += "  vertex " + words(corner_m, unit_m);
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid part\n";
}

std::string obj(const TriangleMesh& mesh, double unit_m) {
  std::string text = "# a part\no part\n";
  for (const Vector3& point_m : mesh.points_m) text += "v " + words(point_m, unit_m);
  for (const Triangle& t : mesh.triangles) {
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
            std::to_string(t[2] + 1) + "\n";
  }
  return text;
}

}  // namespace tenon::tests
