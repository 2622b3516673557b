#include "shared/geometry/distance_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenon {
namespace {

constexpr double kSpacingOfSize = 1.0 / 256.0;
/// So far around the surface, of its size.
constexpr double kMargin = 0.25;

}  // namespace

DistanceGrid::DistanceGrid(const Vector3& size_m)
    : spacing_m_(kSpacingOfSize * size_m.maxCoeff()), per_m_(1.0 / spacing_m_) {
  const double brick_m = static_cast<double>(kEdge) * spacing_m_;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const double extent_m = size_m[i] + 2.0 * kMargin * size_m.maxCoeff();
    const double bricks = std::ceil(extent_m / brick_m);
    low_m_[i] = -0.5 * bricks * brick_m;
    last_[axis] = static_cast<double>(kEdge) * bricks - 1.0;
    stride_[axis] = count_;
    count_ *= static_cast<std::size_t>(bricks);
  }
  bricks_ = std::make_unique<std::atomic<Brick*>[]>(count_);
}

DistanceGrid::~DistanceGrid() {
  std::for_each(bricks_.get(), bricks_.get() + count_,
                [](const std::atomic<Brick*>& brick) { delete brick.load(); });
}

DistanceGrid::Brick& DistanceGrid::make_brick(std::atomic<Brick*>& slot) {
  auto made = std::make_unique<Brick>();
  for (Node& node : *made) node.store(std::numeric_limits<float>::quiet_NaN());
  Brick* before = nullptr;
  if (!slot.compare_exchange_strong(before, made.get(), std::memory_order_acq_rel)) {
    return *before;  // another thread has been here
  }
  return *made.release();
}

}  // namespace tenon
