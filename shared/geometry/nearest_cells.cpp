#include "shared/geometry/nearest_cells.h"

#include <algorithm>
#include <cmath>

namespace tenon {
namespace {

constexpr double kCellOfSize = 1.0 / 64.0;
/// So far around the triangles, in cells: what moves by is near them most of the time.
constexpr double kMarginCells = 16.0;
/// With more triangles than this a cell is cut, at most so often.
constexpr std::size_t kEnough = 12;
constexpr int kLevelMax = 3;
/// With more triangles than this the tree is as fast.
constexpr std::size_t kCandidatesMax = 64;

}  // namespace

NearestCells::Cell::~Cell() {
  if (!parts) return;
  for (const Slot& part : *parts) delete part.load();
}

NearestCells::NearestCells(const Vector3& size_m) : cell_m_(kCellOfSize * size_m.maxCoeff()) {
  std::size_t all = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double extent = size_m[static_cast<Eigen::Index>(axis)] / cell_m_ + 2.0 * kMarginCells;
    count_[axis] = static_cast<std::size_t>(std::ceil(extent));
    low_m_[static_cast<Eigen::Index>(axis)] = -0.5 * static_cast<double>(count_[axis]) * cell_m_;
    all *= count_[axis];
  }
  cells_ = std::make_unique<Slot[]>(all);
}

NearestCells::~NearestCells() {
  const std::size_t all = count_[0] * count_[1] * count_[2];
  std::for_each(cells_.get(), cells_.get() + all, [](const Slot& slot) { delete slot.load(); });
}

NearestOnTriangle NearestCells::nearest(const TriangleTree& tree, const Vector3& point_m,
                                        std::uint32_t guess, Known& known) const {
  if ((point_m - known.middle_m).cwiseAbs().maxCoeff() <= known.half_m) {
    return tree.nearest_of(point_m, known.near, guess);
  }
  known.half_m = -1.0;
  std::size_t index = 0;
  Vector3 middle_m;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const double at = std::floor((point_m[i] - low_m_[i]) / cell_m_);
    if (!(at >= 0.0 && at < static_cast<double>(count_[axis]))) return tree.nearest(point_m, guess);
    index = index * count_[axis] + static_cast<std::size_t>(at);
    middle_m[i] = low_m_[i] + (at + 0.5) * cell_m_;
  }
  const Cell* cell = &cell_in(cells_[index], tree, middle_m, 0);
  int level = 1;
  for (; cell->parts; ++level) {
    const double quarter_m = std::ldexp(cell_m_, -level - 1);
    std::size_t part = 0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const bool beyond = point_m[axis] >= middle_m[axis];
      part = 2 * part + static_cast<std::size_t>(beyond);
      middle_m[axis] += beyond ? quarter_m : -quarter_m;
    }
    cell = &cell_in((*cell->parts)[part], tree, middle_m, level);
  }
  if (cell->near.empty()) return tree.nearest(point_m, guess);
  known = {middle_m, std::ldexp(cell_m_, -level), cell->near};
  return tree.nearest_of(point_m, cell->near, guess);
}

// The nearest to a point in the cell is no farther than half its diagonal more than the nearest to
// its middle, and no farther again from the middle; and a little for rounding.
const NearestCells::Cell& NearestCells::cell_in(Slot& slot, const TriangleTree& tree,
                                                const Vector3& middle_m, int level) const {
  if (const Cell* found = slot.load(std::memory_order_acquire)) return *found;
  constexpr double kRounding = 1.0 + 1e-6;
  const double diagonal_m = std::sqrt(3.0) * std::ldexp(cell_m_, -level);
  const double radius_m = std::sqrt(tree.nearest(middle_m).square_m2) + diagonal_m;
  auto made = std::make_unique<Cell>();
  const bool last = level == kLevelMax;
  const std::size_t most = last ? kCandidatesMax : kEnough;
  if (tree.within(middle_m, kRounding * radius_m, most, made->near)) {
    made->near.shrink_to_fit();
  } else if (!last) {
    made->parts = std::make_unique<std::array<Slot, 8>>();
  }
  const Cell* before = nullptr;
  if (!slot.compare_exchange_strong(before, made.get(), std::memory_order_acq_rel)) {
    return *before;  // another thread has found the same
  }
  return *made.release();
}

}  // namespace tenon
