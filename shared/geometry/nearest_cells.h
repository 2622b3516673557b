#pragma once
// What a tree of triangles says of the nearest one, sooner: space is cut into cells, and each cell
// remembers which triangles can be nearest to a point in it, from the first question on. Any number
// of threads may ask at once.

#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "shared/geometry/triangle_tree.h"

namespace tenon {

class NearestCells {
 public:
  /// @param size_m edge lengths of the box around the triangles, which has its centre at the origin
  explicit NearestCells(const Vector3& size_m);
  ~NearestCells();
  NearestCells(const NearestCells&) = delete;
  NearestCells& operator=(const NearestCells&) = delete;

  /// The numbers of tree.nearest(). @param tree of the triangles, always the same one
  [[nodiscard]] NearestOnTriangle nearest(const TriangleTree& tree, const Vector3& point_m,
                                          std::uint32_t guess) const;

 private:
  /// In ascending order; empty where they are so many that the tree is as fast.
  using Candidates = std::vector<std::uint32_t>;

  [[nodiscard]] const Candidates& candidates(const TriangleTree& tree, std::size_t cell,
                                             const Vector3& middle_m) const;

  double cell_m_;
  Vector3 low_m_;  ///< the corner of the first cell
  std::array<std::size_t, 3> count_{};
  std::unique_ptr<std::atomic<const Candidates*>[]> cells_;  ///< null: not asked for yet
};

}  // namespace tenon
