#pragma once
// What a tree of triangles says of the nearest one, sooner: space is cut into cells, and each cell
// remembers which triangles can be nearest to a point in it, from the first question on. Where
// these are many, as within a round hole, a cell is cut into eight again. Any number of threads may
// ask at once.

#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
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

  /// The cell that a point was in, for whoever asks again nearby.
  struct Known {
    Vector3 middle_m = Vector3::Zero();
    double half_m = -1.0;                 ///< less than 0: none is known
    std::span<const std::uint32_t> near;  ///< places of triangles in the tree
  };
  /// The numbers of tree.nearest(). @param tree of the triangles, always the same one
  [[nodiscard]] NearestOnTriangle nearest(const TriangleTree& tree, const Vector3& point_m,
                                          std::uint32_t guess, Known& known) const;

 private:
  struct Cell;
  using Slot = std::atomic<const Cell*>;  ///< null: not asked for yet
  struct Cell {
    /// Their places in the tree, in ascending order; empty where they are so many that the tree is
    /// as fast.
    std::vector<std::uint32_t> near;
    std::unique_ptr<std::array<Slot, 8>> parts;  ///< null: not cut again
    ~Cell();
  };

  /// @param level 0 of the first cells, each level's are half as large
  [[nodiscard]] const Cell& cell_in(Slot& slot, const TriangleTree& tree, const Vector3& middle_m,
                                    int level) const;

  double cell_m_;
  Vector3 low_m_;  ///< the corner of the first cell
  std::array<std::size_t, 3> count_{};
  std::unique_ptr<Slot[]> cells_;
};

}  // namespace tenon
