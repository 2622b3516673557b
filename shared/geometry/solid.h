#pragma once
// A closed surface of triangles, and how far points are from it. Immutable after construction: any
// number of threads may ask.

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "shared/geometry/distance_grid.h"
#include "shared/geometry/nearest_cells.h"
#include "shared/geometry/triangle_mesh.h"
#include "shared/geometry/triangle_tree.h"

namespace tenon {

class Solid {
 public:
  /// @param mesh closed, facing outwards (check_mesh() in mesh_check.h), in any place
  explicit Solid(TriangleMesh mesh);

  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  /// Edge lengths of the box around it, which has its centre at the origin.
  [[nodiscard]] const Vector3& size_m() const { return size_m_; }
  /// Where the given mesh had that centre.
  [[nodiscard]] const Vector3& centre_m() const { return centre_m_; }

  struct Place {
    double distance_m = 0.0;  ///< to the surface; negative inside
    Vector3 outwards;         ///< the distance's gradient, a unit vector
    Vector3 nearest_m;        ///< on the surface
    std::uint32_t triangle = 0;
  };
  /// Exact: the closest point of all triangles, the sign by the angle-weighted normal there
  /// (Baerentzen and Aanaes, "Signed distance computation using the angle weighted pseudonormal").
  /// @param guess a triangle that is probably near: it only saves time
  [[nodiscard]] Place place(const Vector3& point_m, std::uint32_t guess = 0) const;
  /// Likewise, of a point that moves: what can be nearest around it is looked up once.
  [[nodiscard]] Place place(const Vector3& point_m, std::uint32_t guess,
                            NearestCells::Known& known) const;
  /// The same from a lattice (DistanceGrid), which is many times as fast: exact along flat walls,
  /// rounded within a lattice cell of edges. The nearest point follows from distance and gradient.
  [[nodiscard]] Place sampled_place(const Vector3& point_m, std::uint32_t guess = 0) const;

  /// The exact distance is no less, and where the lattice knows of it not much more; many times as
  /// fast as place().
  [[nodiscard]] double distance_at_least_m(const Vector3& point_m) const;

  struct Edge {
    std::uint32_t from = 0;  ///< corners of the mesh
    std::uint32_t to = 0;
    /// Half-way between both faces, inwards: 1 m along it is 1 m below either; less far below those
    /// of a blade.
    Vector3 inwards;
  };
  /// Where the surface bends outwards, each once. Where two solids meet, one of these is on the
  /// other's surface: faces and hollow edges need not be looked at. With a face beside another's it
  /// may be on that surface all along and tell no depth, however far one is in the other: then a
  /// place inwards of it does (common_depth.h).
  [[nodiscard]] const std::vector<Edge>& convex_edges() const { return convex_edges_; }

 private:
  /// By the directed edge.
  using TriangleOf = std::unordered_map<std::uint64_t, std::uint32_t>;

  void find_normals();
  void face_slivers(const TriangleOf& triangle_of);
  [[nodiscard]] Place place_at(const Vector3& point_m, const NearestOnTriangle& nearest) const;
  /// The distance of a point that is never asked for again.
  [[nodiscard]] double once_m(const Vector3& point_m, std::uint32_t guess) const;
  [[nodiscard]] const Vector3& normal_at(const NearestOnTriangle& nearest) const;

  Vector3 centre_m_;
  Vector3 size_m_;
  TriangleMesh mesh_;
  TriangleTree tree_;
  NearestCells cells_;
  DistanceGrid grid_;
  std::vector<Vector3> face_normals_;
  std::vector<std::array<Vector3, 3>> edge_normals_;
  std::vector<Vector3> corner_normals_;
  std::vector<Edge> convex_edges_;
};

}  // namespace tenon
