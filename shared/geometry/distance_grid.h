#pragma once
// Signed distances on a lattice, for who needs them fast rather than exactly: between its nodes
// they are interpolated (trilinear), so that flat walls are exact and edges are rounded by a
// fraction of the spacing. A node is asked for when it is first needed. Any number of threads may
// ask at once.

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>

#include "shared/math/pose.h"

namespace tenon {

class DistanceGrid {
 public:
  /// @param size_m edge lengths of the box around the surface, which has its centre at the origin
  explicit DistanceGrid(const Vector3& size_m);
  ~DistanceGrid();
  DistanceGrid(const DistanceGrid&) = delete;
  DistanceGrid& operator=(const DistanceGrid&) = delete;

  struct Sample {
    double distance_m = 0.0;
    Vector3 gradient = Vector3::Zero();  ///< of the interpolation: no unit vector
  };
  /// Empty where the lattice has no nodes. @param exact_m a node's distance, always the same
  /// function
  template <typename Exact>
  [[nodiscard]] std::optional<Sample> at(const Vector3& point_m, const Exact& exact_m) const;
  /// No more than the true distance, which changes by no more than the way from the nearest node.
  /// Empty where the lattice has no nodes.
  template <typename Exact>
  [[nodiscard]] std::optional<double> at_least_m(const Vector3& point_m,
                                                 const Exact& exact_m) const;

 private:
  static constexpr std::size_t kEdge = 4;  ///< nodes along a brick's edge
  using Node = std::atomic<float>;         ///< not a number: not asked for yet
  using Brick = std::array<Node, kEdge * kEdge * kEdge>;

  /// Of a point along an axis: the nodes before and after it, as parts of a brick's number and of a
  /// node's within it, and where it is between them.
  struct Between {
    std::array<std::size_t, 2> brick{};
    std::array<std::size_t, 2> within{};
    std::array<double, 2> node_m{};
    double part = 0.0;
  };
  /// @return whether both are there
  [[nodiscard]] bool between(Eigen::Index axis, double at_m, Between& found) const {
    const double scaled = (at_m - low_m_[axis]) * per_m_;
    const auto i = static_cast<std::size_t>(axis);
    if (!(scaled >= 0.0 && scaled < last_[i])) return false;
    const auto low = static_cast<std::size_t>(scaled);
    for (std::size_t side = 0; side < 2; ++side) {
      found.brick[side] = (low + side) / kEdge * stride_[i];
      found.within[side] = (low + side) % kEdge * (i == 0 ? kEdge * kEdge : i == 1 ? kEdge : 1);
      found.node_m[side] = node_m(axis, low + side);
    }
    found.part = scaled - static_cast<double>(low);
    return true;
  }
  /// The same to the last bit from whichever cell it is asked for: what is computed there is kept.
  [[nodiscard]] double node_m(Eigen::Index axis, std::size_t number) const {
    return low_m_[axis] + static_cast<double>(number) * spacing_m_;
  }
  [[nodiscard]] Node& node(std::size_t brick, std::size_t within) const {
    Brick* known = bricks_[brick].load(std::memory_order_acquire);
    return (known != nullptr ? *known : make_brick(bricks_[brick]))[within];
  }
  template <typename Exact>
  [[nodiscard]] static double distance_at(Node& node, const Vector3& node_m, const Exact& exact_m) {
    float distance_m = node.load(std::memory_order_relaxed);
    if (std::isnan(distance_m)) {
      distance_m = static_cast<float>(exact_m(node_m));
      node.store(distance_m, std::memory_order_relaxed);
    }
    return static_cast<double>(distance_m);
  }
  [[nodiscard]] static Brick& make_brick(std::atomic<Brick*>& slot);

  double spacing_m_;
  double per_m_;                         ///< of nodes
  Vector3 low_m_;                        ///< the first node
  std::array<double, 3> last_{};         ///< number of the last node along each axis
  std::array<std::size_t, 3> stride_{};  ///< of a brick's number
  std::size_t count_ = 1;
  std::unique_ptr<std::atomic<Brick*>[]> bricks_;
};

template <typename Exact>
std::optional<double> DistanceGrid::at_least_m(const Vector3& point_m, const Exact& exact_m) const {
  const Vector3 scaled = per_m_ * (point_m - low_m_);
  std::size_t brick = 0;
  std::size_t within = 0;
  Vector3 nearest_m;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    if (!(scaled[i] >= 0.0 && scaled[i] < last_[axis])) return std::nullopt;
    const auto low = static_cast<std::size_t>(scaled[i]);
    const std::size_t nearest = scaled[i] - static_cast<double>(low) < 0.5 ? low : low + 1;
    brick += nearest / kEdge * stride_[axis];
    within = within * kEdge + nearest % kEdge;
    nearest_m[i] = node_m(i, nearest);
  }
  const double distance_m = distance_at(node(brick, within), nearest_m, exact_m);
  return distance_m - (point_m - nearest_m).norm();
}

template <typename Exact>
std::optional<DistanceGrid::Sample> DistanceGrid::at(const Vector3& point_m,
                                                     const Exact& exact_m) const {
  Between x;
  Between y;
  Between z;
  if (!between(0, point_m.x(), x) || !between(1, point_m.y(), y) || !between(2, point_m.z(), z)) {
    return std::nullopt;
  }
  // Along x, then y, then z; the gradient likewise.
  std::array<double, 4> along_x_m{};
  std::array<double, 4> slope_x{};
  for (std::size_t row = 0; row < 4; ++row) {
    const std::size_t at_y = row & 1U;
    const std::size_t at_z = row >> 1U;
    std::array<double, 2> end_m{};
    for (std::size_t at_x = 0; at_x < 2; ++at_x) {
      end_m[at_x] = distance_at(node(x.brick[at_x] + y.brick[at_y] + z.brick[at_z],
                                     x.within[at_x] + y.within[at_y] + z.within[at_z]),
                                {x.node_m[at_x], y.node_m[at_y], z.node_m[at_z]}, exact_m);
    }
    slope_x[row] = end_m[1] - end_m[0];
    along_x_m[row] = end_m[0] + x.part * slope_x[row];
  }
  const auto between_rows = [&](const std::array<double, 4>& of, std::size_t low) {
    return of[low] + y.part * (of[low + 1] - of[low]);
  };
  const double z_low_m = between_rows(along_x_m, 0);
  const double z_high_m = between_rows(along_x_m, 2);
  const double slope_x_low = between_rows(slope_x, 0);
  const double slope_y_low = along_x_m[1] - along_x_m[0];
  const double slope_y_high = along_x_m[3] - along_x_m[2];
  return Sample{
      z_low_m + z.part * (z_high_m - z_low_m),
      per_m_ * Vector3(slope_x_low + z.part * (between_rows(slope_x, 2) - slope_x_low),
                       slope_y_low + z.part * (slope_y_high - slope_y_low), z_high_m - z_low_m)};
}

}  // namespace tenon
