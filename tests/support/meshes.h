#pragma once
// Bodies of triangles, and the files that they stand in, written without the code under test.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "shared/geometry/triangle_mesh.h"

namespace tenon::tests {

using Profile = std::vector<Eigen::Vector2d>;

[[nodiscard]] TriangleMesh box_mesh(const Vector3& size_m, const Vector3& centre_m = {0, 0, 0});
/// A regular polygon, its corners on the circle, the first on x.
[[nodiscard]] Profile round_profile(double radius_m, int corners);
/// Both in one list of triangles, sharing nothing.
[[nodiscard]] TriangleMesh together(const TriangleMesh& a, const TriangleMesh& b);
[[nodiscard]] TriangleMesh turned_about(TriangleMesh mesh);

/// Horizontal outlines, each with as many corners, joined from one to the next; the first and the
/// last are closed by a fan about their middle. Upwards along the outside, downwards in a hole.
struct Ring3 {
  Profile profile_m;
  double z_m = 0.0;
};
[[nodiscard]] TriangleMesh lofted(const std::vector<Ring3>& rings);

[[nodiscard]] std::string binary_stl(const TriangleMesh& mesh, double unit_m);
[[nodiscard]] std::string ascii_stl(const TriangleMesh& mesh, double unit_m);
[[nodiscard]] std::string obj(const TriangleMesh& mesh, double unit_m);

}  // namespace tenon::tests
