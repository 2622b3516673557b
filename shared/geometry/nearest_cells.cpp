#include "shared/geometry/nearest_cells.h"

#include <algorithm>
#include <cmath>

namespace tenon {
namespace {

constexpr double kCellOfSize = 1.0 / 64.0;
/// So far around the triangles, in cells: what moves by is near them most of the time.
constexpr double kMarginCells = 16.0;
/// With more triangles than this the tree is as fast.
constexpr std::size_t kCandidatesMax = 64;

}  // namespace

NearestCells::NearestCells(const Vector3& size_m) : cell_m_(kCellOfSize * size_m.maxCoeff()) {
  std::size_t all = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double extent = size_m[static_cast<Eigen::Index>(axis)] / cell_m_ + 2.0 * kMarginCells;
    count_[axis] = static_cast<std::size_t>(std::ceil(extent));
    low_m_[static_cast<Eigen::Index>(axis)] = -0.5 * static_cast<double>(count_[axis]) * cell_m_;
    all *= count_[axis];
  }
  cells_ = std::make_unique<std::atomic<const Candidates*>[]>(all);
}

NearestCells::~NearestCells() {
  const std::size_t all = count_[0] * count_[1] * count_[2];
  std::for_each(cells_.get(), cells_.get() + all, [](const auto& cell) { delete cell.load(); });
}

NearestOnTriangle NearestCells::nearest(const TriangleTree& tree, const Vector3& point_m,
                                        std::uint32_t guess) const {
  std::size_t cell = 0;
  Vector3 middle_m;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const double at = std::floor((point_m[i] - low_m_[i]) / cell_m_);
    if (!(at >= 0.0 && at < static_cast<double>(count_[axis]))) return tree.nearest(point_m, guess);
    cell = cell * count_[axis] + static_cast<std::size_t>(at);
    middle_m[i] = low_m_[i] + (at + 0.5) * cell_m_;
  }
  const Candidates& near = candidates(tree, cell, middle_m);
  return near.empty() ? tree.nearest(point_m, guess) : tree.nearest_of(point_m, near, guess);
}

// The nearest to a point in the cell is no farther than half its diagonal more than the nearest to
// its middle, and no farther again from the middle; and a little for rounding.
const NearestCells::Candidates& NearestCells::candidates(const TriangleTree& tree, std::size_t cell,
                                                         const Vector3& middle_m) const {
  std::atomic<const Candidates*>& known = cells_[cell];
  if (const Candidates* found = known.load(std::memory_order_acquire)) return *found;
  constexpr double kRounding = 1.0 + 1e-6;
  const double diagonal_m = std::sqrt(3.0) * cell_m_;
  const double radius_m = std::sqrt(tree.nearest(middle_m).square_m2) + diagonal_m;
  auto found = std::make_unique<Candidates>();
  (void)tree.within(middle_m, kRounding * radius_m, kCandidatesMax, *found);
  found->shrink_to_fit();
  const Candidates* before = nullptr;
  if (!known.compare_exchange_strong(before, found.get(), std::memory_order_acq_rel)) {
    return *before;  // another thread has found the same
  }
  return *found.release();
}

}  // namespace tenon
