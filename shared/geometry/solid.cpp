#include "shared/geometry/solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace tenon {
namespace {

// What single precision leaves of a flat face.
constexpr double kFlat_rad = 2e-4;
// Triangles that differ by less are one plane to every purpose.
constexpr double kOnePlane_rad = 1e-6;
// So near the surface the way to it has no direction.
constexpr double kOnSurface_m = 1e-9;

Eigen::AlignedBox3d box_around(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vector3& point_m : mesh.points_m) box.extend(point_m);
  return box;
}

TriangleMesh moved(TriangleMesh mesh, const Vector3& by_m) {
  for (Vector3& point_m : mesh.points_m) point_m += by_m;
  return mesh;
}

std::uint64_t key_of(std::uint32_t from, std::uint32_t to) {
  return (static_cast<std::uint64_t>(from) << 32U) | to;
}

double angle_at(const Vector3& corner_m, const Vector3& a_m, const Vector3& b_m) {
  const Vector3 a = a_m - corner_m;
  const Vector3 b = b_m - corner_m;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

Solid::Solid(TriangleMesh mesh)
    : centre_m_(box_around(mesh).center()),
      size_m_(box_around(mesh).sizes()),
      mesh_(moved(std::move(mesh), -centre_m_)),
      tree_(mesh_) {
  find_normals();
}

void Solid::find_normals() {
  const std::size_t count = mesh_.triangles.size();
  face_normals_.resize(count);
  edge_normals_.resize(count);
  faces_.resize(count);
  std::iota(faces_.begin(), faces_.end(), 0U);
  corner_normals_.assign(mesh_.points_m.size(), Vector3::Zero());
  std::unordered_map<std::uint64_t, std::uint32_t> triangle_of;
  for (std::size_t i = 0; i < count; ++i) {
    const std::array<Vector3, 3> c = mesh_.corners_m(i);
    face_normals_[i] = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
    for (std::size_t j = 0; j < 3; ++j) {
      const Triangle& t = mesh_.triangles[i];
      triangle_of[key_of(t[j], t[(j + 1) % 3])] = static_cast<std::uint32_t>(i);
      corner_normals_[t[j]] += angle_at(c[j], c[(j + 1) % 3], c[(j + 2) % 3]) * face_normals_[i];
    }
  }
  for (Vector3& normal : corner_normals_) normal.normalize();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::uint32_t from = mesh_.triangles[i][j];
      const std::uint32_t to = mesh_.triangles[i][(j + 1) % 3];
      const Vector3& own = face_normals_[i];
      const std::uint32_t beyond = triangle_of.at(key_of(to, from));
      const Vector3& other = face_normals_[beyond];
      edge_normals_[i][j] = (own + other).normalized();
      const Vector3 along_m = mesh_.points_m[to] - mesh_.points_m[from];
      if (own.cross(other).norm() < kOnePlane_rad && own.dot(other) > 0.0) {
        join_faces(static_cast<std::uint32_t>(i), beyond);
      }
      const double bend = own.cross(other).dot(along_m) / along_m.norm();
      if (from < to && std::atan2(bend, own.dot(other)) > kFlat_rad) {
        convex_edges_.push_back({from, to});
      }
    }
  }
  for (std::uint32_t i = 0; i < count; ++i) faces_[i] = face_of(i);
}

std::uint32_t Solid::face_of(std::uint32_t triangle) const {
  while (faces_[triangle] != triangle) triangle = faces_[triangle];
  return triangle;
}

void Solid::join_faces(std::uint32_t triangle, std::uint32_t other) {
  const std::uint32_t a = face_of(triangle);
  const std::uint32_t b = face_of(other);
  faces_[std::max(a, b)] = std::min(a, b);
}

double Solid::flat_for_m(const Vector3& point_m, const Place& place, double at_most_m) const {
  if (!place.on_face) return 0.0;
  const double own_m = std::abs(place.distance_m);
  const double others_m =
      tree_.distance_to_others_m(point_m, faces_, faces_[place.triangle], own_m + 2.0 * at_most_m);
  // Each of the two distances changes by no more than the way.
  return std::clamp(0.5 * (others_m - own_m), 0.0, at_most_m);
}

const Vector3& Solid::normal_at(const NearestOnTriangle& nearest) const {
  const auto part = static_cast<std::size_t>(nearest.part);
  if (nearest.part == TrianglePart::kFace) return face_normals_[nearest.triangle];
  if (nearest.part < TrianglePart::kCorner0) {
    return edge_normals_[nearest.triangle][part - static_cast<std::size_t>(TrianglePart::kEdge0)];
  }
  return corner_normals_[mesh_.triangles[nearest.triangle]
                                        [part - static_cast<std::size_t>(TrianglePart::kCorner0)]];
}

Solid::Place Solid::place(const Vector3& point_m, std::uint32_t guess) const {
  const NearestOnTriangle nearest = tree_.nearest(point_m, guess);
  const Vector3& normal = normal_at(nearest);
  const Vector3 off_m = point_m - nearest.at_m;
  const double distance_m = std::sqrt(nearest.square_m2);
  const double sign = off_m.dot(normal) >= 0.0 ? 1.0 : -1.0;
  const bool near = distance_m < kOnSurface_m || nearest.part == TrianglePart::kFace;
  return {sign * distance_m, near ? normal : Vector3(sign / distance_m * off_m), nearest.at_m,
          nearest.triangle, nearest.part == TrianglePart::kFace};
}

}  // namespace tenon
