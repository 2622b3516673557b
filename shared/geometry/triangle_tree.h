#pragma once
// A tree of boxes around the triangles of a mesh: which of them is nearest to a point, which come
// near a box. Immutable after construction: any number of threads may ask.

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "shared/geometry/triangle_mesh.h"

namespace tenon {

/// Where on a triangle its nearest point lies: amid its face, on the edge from corner i to the
/// next, or at corner i.
enum class TrianglePart : std::uint8_t {
  kFace,
  kEdge0,
  kEdge1,
  kEdge2,
  kCorner0,
  kCorner1,
  kCorner2
};

struct NearestOnTriangle {
  Vector3 at_m = Vector3::Zero();
  double square_m2 = std::numeric_limits<double>::infinity();  ///< of the distance
  std::uint32_t triangle = 0;
  TrianglePart part = TrianglePart::kFace;
};

/// A triangle made ready for many questions.
class TriangleShape {
 public:
  explicit TriangleShape(const std::array<Vector3, 3>& corners_m);

  [[nodiscard]] const std::array<Vector3, 3>& corners_m() const { return corners_m_; }
  /// Takes the place of `best` where the triangle is nearer to the point, or as near and its index
  /// lower.
  void offer(const Vector3& point_m, std::uint32_t index, NearestOnTriangle& best) const;

 private:
  std::array<Vector3, 3> corners_m_;
  Vector3 normal_;
  std::array<Vector3, 3> along_;    ///< from corner i to the next, unit vectors
  std::array<Vector3, 3> inwards_;  ///< across the edges, unit vectors
  std::array<double, 3> length_m_{};
};

class TriangleTree {
 public:
  /// @param mesh at least one triangle
  explicit TriangleTree(const TriangleMesh& mesh);

  /// Of triangles at the same distance the one with the lowest index, whatever the guess.
  /// @param guess a triangle that is probably near: it only saves time
  [[nodiscard]] NearestOnTriangle nearest(const Vector3& point_m, std::uint32_t guess = 0) const;

  /// The places of all triangles that are no farther than this from a point, in ascending order.
  /// @return false where they are more than `count_max`: `places` is then empty
  [[nodiscard]] bool within(const Vector3& point_m, double radius_m, std::size_t count_max,
                            std::vector<std::uint32_t>& places) const;
  /// As nearest(), of the triangles at these places and the guess alone.
  [[nodiscard]] NearestOnTriangle nearest_of(const Vector3& point_m,
                                             std::span<const std::uint32_t> places,
                                             std::uint32_t guess) const;

  /// Calls `visit` with every triangle whose leaf's box meets `box`, some others included.
  void near_box(const Eigen::AlignedBox3d& box,
                const std::function<void(std::uint32_t)>& visit) const;

 private:
  /// A leaf holds the triangles first_ to first_ + count_, another node has its children at first_
  /// and the next.
  struct Node {
    Vector3 low_m;
    Vector3 high_m;
    std::uint32_t first = 0;
    std::uint32_t count = 0;

    [[nodiscard]] double square_m2(const Vector3& point_m) const {
      return (point_m.cwiseMax(low_m).cwiseMin(high_m) - point_m).squaredNorm();
    }
  };
  struct Leaf {
    TriangleShape shape;
    std::uint32_t triangle = 0;
  };

  /// The places of the triangles that may be nearer than `best`, which `look` betters.
  template <typename Look>
  void descend(const Vector3& point_m, const NearestOnTriangle& best, const Look& look) const;
  void split(std::size_t node, std::vector<Vector3>& middles_m);

  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;          ///< in the tree's order
  std::vector<std::uint32_t> place_;  ///< of a triangle among them
};

}  // namespace tenon
