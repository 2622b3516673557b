#include "shared/geometry/solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "shared/geometry/mesh_needles.h"

namespace tenon {
namespace {

// What single precision leaves of a flat face.
constexpr double kFlat_rad = 2e-4;
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

Vector3 inwards_of(const Vector3& own, const Vector3& other) {
  constexpr double kBlade = 0.05;  // 36 degrees between the faces
  return -(own + other) / std::max(kBlade, 1.0 + own.dot(other));
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
      tree_(mesh_),
      cells_(size_m_),
      grid_(size_m_) {
  find_normals();
}

// A sliver faces as the triangle across its longest edge does.
void Solid::face_slivers(const TriangleOf& triangle_of) {
  std::vector<std::uint32_t> left;
  std::vector<bool> faces(mesh_.triangles.size(), true);
  for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
    if (height_m(mesh_, mesh_.triangles[i]) >= kSliver_m) continue;
    left.push_back(i);
    faces[i] = false;
  }
  const auto beyond = [&](std::uint32_t sliver) {
    const Triangle& t = mesh_.triangles[sliver];
    const auto c = mesh_.corners_m(sliver);
    std::size_t longest = 0;
    for (std::size_t j = 1; j < 3; ++j) {
      const auto length_m = [&](std::size_t k) { return (c[(k + 1) % 3] - c[k]).norm(); };
      if (length_m(j) > length_m(longest)) longest = j;
    }
    return triangle_of.at(key_of(t[(longest + 1) % 3], t[longest]));
  };
  for (std::size_t before = left.size() + 1; left.size() < before;) {
    before = left.size();
    std::erase_if(left, [&](std::uint32_t i) {
      const std::uint32_t other = beyond(i);
      if (faces[other]) face_normals_[i] = face_normals_[other];
      return faces[i] = faces[other];
    });
  }
}

void Solid::find_normals() {
  const std::size_t count = mesh_.triangles.size();
  face_normals_.resize(count);
  edge_normals_.resize(count);
  corner_normals_.assign(mesh_.points_m.size(), Vector3::Zero());
  TriangleOf triangle_of;
  for (std::size_t i = 0; i < count; ++i) {
    const std::array<Vector3, 3> c = mesh_.corners_m(i);
    face_normals_[i] = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
    for (std::size_t j = 0; j < 3; ++j) {
      const Triangle& t = mesh_.triangles[i];
      triangle_of[key_of(t[j], t[(j + 1) % 3])] = static_cast<std::uint32_t>(i);
    }
  }
  face_slivers(triangle_of);
  for (std::size_t i = 0; i < count; ++i) {
    const std::array<Vector3, 3> c = mesh_.corners_m(i);
    for (std::size_t j = 0; j < 3; ++j) {
      const Triangle& t = mesh_.triangles[i];
      corner_normals_[t[j]] += angle_at(c[j], c[(j + 1) % 3], c[(j + 2) % 3]) * face_normals_[i];
    }
  }
  for (Vector3& normal : corner_normals_) normal.normalize();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::uint32_t from = mesh_.triangles[i][j];
      const std::uint32_t to = mesh_.triangles[i][(j + 1) % 3];
      const Vector3& own = face_normals_[i];
      const Vector3& other = face_normals_[triangle_of.at(key_of(to, from))];
      edge_normals_[i][j] = (own + other).normalized();
      const Vector3 along_m = mesh_.points_m[to] - mesh_.points_m[from];
      const double bend = own.cross(other).dot(along_m) / along_m.norm();
      if (from < to && std::atan2(bend, own.dot(other)) > kFlat_rad) {
        convex_edges_.push_back({from, to, inwards_of(own, other)});
      }
    }
  }
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

Solid::Place Solid::place_at(const Vector3& point_m, const NearestOnTriangle& nearest) const {
  const Vector3& normal = normal_at(nearest);
  const Vector3 off_m = point_m - nearest.at_m;
  const double distance_m = std::sqrt(nearest.square_m2);
  const double sign = off_m.dot(normal) >= 0.0 ? 1.0 : -1.0;
  const bool near = distance_m < kOnSurface_m || nearest.part == TrianglePart::kFace;
  return {sign * distance_m, near ? normal : Vector3(sign / distance_m * off_m), nearest.at_m,
          nearest.triangle};
}

Solid::Place Solid::place(const Vector3& point_m, std::uint32_t guess) const {
  NearestCells::Known known;
  return place(point_m, guess, known);
}

Solid::Place Solid::place(const Vector3& point_m, std::uint32_t guess,
                          NearestCells::Known& known) const {
  return place_at(point_m, cells_.nearest(tree_, point_m, guess, known));
}

double Solid::once_m(const Vector3& point_m, std::uint32_t guess) const {
  return place_at(point_m, tree_.nearest(point_m, guess)).distance_m;
}

Solid::Place Solid::sampled_place(const Vector3& point_m, std::uint32_t guess) const {
  // Where walls on both sides are as near, the lattice knows of no way outwards.
  constexpr double kSteepMin = 0.05;
  const auto sample =
      grid_.at(point_m, [&](const Vector3& node_m) { return once_m(node_m, guess); });
  if (!sample) return place(point_m, guess);
  const double steep = sample->gradient.norm();
  if (steep < kSteepMin) return place(point_m, guess);
  const Vector3 outwards = sample->gradient / steep;
  return {sample->distance_m, outwards, point_m - sample->distance_m * outwards, guess};
}

double Solid::distance_at_least_m(const Vector3& point_m) const {
  // Nodes are kept in single precision.
  constexpr double kRounding = 1e-6;
  const auto at_least_m =
      grid_.at_least_m(point_m, [&](const Vector3& node_m) { return once_m(node_m, 0); });
  return at_least_m ? *at_least_m - kRounding * size_m_.maxCoeff() : place(point_m).distance_m;
}

}  // namespace tenon
