#include "shared/geometry/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace tenon {
namespace {

constexpr std::uint32_t kLeafMax = 4;
// Halving so many triangles again and again goes no deeper than this.
constexpr std::size_t kDepthMax = 24;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

TrianglePart part_of(TrianglePart first, std::size_t index) {
  return static_cast<TrianglePart>(static_cast<std::size_t>(first) + index);
}

/// A bound that rounding cannot make too low.
double no_farther_m2(const NearestOnTriangle& best) {
  return best.square_m2 * (1.0 + 1e-9) + 1e-30;
}

}  // namespace

TriangleShape::TriangleShape(const std::array<Vector3, 3>& corners_m)
    : corners_m_(corners_m),
      normal_((corners_m[1] - corners_m[0]).cross(corners_m[2] - corners_m[0]).normalized()) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 edge_m = corners_m[(i + 1) % 3] - corners_m[i];
    length_m_[i] = edge_m.norm();
    along_[i] = edge_m.normalized();
    inwards_[i] = normal_.cross(along_[i]);
  }
}

void TriangleShape::offer(const Vector3& point_m, std::uint32_t index,
                          NearestOnTriangle& best) const {
  const double bound_m2 = no_farther_m2(best);
  const double above_m = normal_.dot(point_m - corners_m_[0]);
  if (above_m * above_m > bound_m2) return;
  const auto take = [&](const Vector3& at_m, TrianglePart part) {
    const double square_m2 = (point_m - at_m).squaredNorm();
    if (square_m2 < best.square_m2 || (square_m2 == best.square_m2 && index < best.triangle)) {
      best = {at_m, square_m2, index, part};
    }
  };
  // Inside of all three edges the plane is nearest, else one of the edges that it is outside of.
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 off_m = point_m - corners_m_[i];
    const double in_m = inwards_[i].dot(off_m);
    if (in_m > 0.0) continue;
    inside = false;
    if (in_m * in_m > bound_m2) return;
    const double way_m = along_[i].dot(off_m);
    if (way_m <= 0.0) {
      take(corners_m_[i], part_of(TrianglePart::kCorner0, i));
    } else if (way_m >= length_m_[i]) {
      take(corners_m_[(i + 1) % 3], part_of(TrianglePart::kCorner0, (i + 1) % 3));
    } else {
      take(corners_m_[i] + way_m * along_[i], part_of(TrianglePart::kEdge0, i));
    }
  }
  if (inside) take(point_m - above_m * normal_, TrianglePart::kFace);
}

TriangleTree::TriangleTree(const TriangleMesh& mesh) : place_(mesh.triangles.size()) {
  std::vector<Vector3> middles_m;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::array<Vector3, 3> c = mesh.corners_m(i);
    leaves_.push_back({TriangleShape(c), static_cast<std::uint32_t>(i)});
    middles_m.emplace_back((c[0] + c[1] + c[2]) / 3.0);
  }
  nodes_.push_back(
      {Vector3::Zero(), Vector3::Zero(), 0, static_cast<std::uint32_t>(leaves_.size())});
  // Children stand behind their parents, so that the list is its own queue.
  for (std::size_t node = 0; node < nodes_.size(); ++node) split(node, middles_m);
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    place_[leaves_[i].triangle] = static_cast<std::uint32_t>(i);
  }
}

void TriangleTree::split(std::size_t node, std::vector<Vector3>& middles_m) {
  const std::uint32_t first = nodes_[node].first;
  const std::uint32_t count = nodes_[node].count;
  const auto begin = leaves_.begin() + first;
  Eigen::AlignedBox3d box;
  Eigen::AlignedBox3d middles;
  std::for_each(begin, begin + count, [&](const Leaf& leaf) {
    for (const Vector3& corner_m : leaf.shape.corners_m()) box.extend(corner_m);
    middles.extend(middles_m[leaf.triangle]);
  });
  nodes_[node].low_m = box.min();
  nodes_[node].high_m = box.max();
  if (count <= kLeafMax) return;
  Eigen::Index axis = 0;
  middles.sizes().maxCoeff(&axis);
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [&](const Leaf& a, const Leaf& b) {
    const double at_a = middles_m[a.triangle][axis];
    const double at_b = middles_m[b.triangle][axis];
    return at_a != at_b ? at_a < at_b : a.triangle < b.triangle;
  });
  nodes_[node].first = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].count = 0;
  nodes_.push_back({Vector3::Zero(), Vector3::Zero(), first, half});
  nodes_.push_back({Vector3::Zero(), Vector3::Zero(), first + half, count - half});
}

template <typename Look>
void TriangleTree::descend(const Vector3& point_m, const NearestOnTriangle& best,
                           const Look& look) const {
  const auto may_hold = [&](double square_m2) { return square_m2 <= no_farther_m2(best); };
  std::array<std::pair<std::uint32_t, double>, kDepthMax> waiting;
  std::size_t count = 0;
  waiting[count++] = {0, nodes_.front().square_m2(point_m)};
  while (count > 0) {
    const auto [index, square_m2] = waiting[--count];
    if (!may_hold(square_m2)) continue;
    const Node& node = nodes_[index];
    if (node.count > 0) {
      for (std::uint32_t i = 0; i < node.count; ++i) look(node.first + i);
      continue;
    }
    std::pair<std::uint32_t, double> near{node.first, nodes_[node.first].square_m2(point_m)};
    std::pair<std::uint32_t, double> far{node.first + 1, nodes_[node.first + 1].square_m2(point_m)};
    if (far.second < near.second) std::swap(near, far);
    if (may_hold(far.second)) waiting[count++] = far;
    if (may_hold(near.second)) waiting[count++] = near;
  }
}

NearestOnTriangle TriangleTree::nearest(const Vector3& point_m, std::uint32_t guess) const {
  NearestOnTriangle best;
  leaves_[place_[guess]].shape.offer(point_m, guess, best);
  descend(point_m, best, [&](std::uint32_t place) {
    leaves_[place].shape.offer(point_m, leaves_[place].triangle, best);
  });
  return best;
}

bool TriangleTree::within(const Vector3& point_m, double radius_m, std::size_t count_max,
                          std::vector<std::uint32_t>& places) const {
  places.clear();
  NearestOnTriangle reach;
  reach.square_m2 = radius_m * radius_m;
  descend(point_m, reach, [&](std::uint32_t place) {
    if (places.size() > count_max) return;
    NearestOnTriangle own = reach;
    own.triangle = kNone;
    leaves_[place].shape.offer(point_m, leaves_[place].triangle, own);
    if (own.triangle == kNone) return;
    places.push_back(place);
    if (places.size() > count_max) reach.square_m2 = -1.0;  // enough is known
  });
  if (places.size() > count_max) places.clear();
  std::sort(places.begin(), places.end());
  return !places.empty();
}

NearestOnTriangle TriangleTree::nearest_of(const Vector3& point_m,
                                           std::span<const std::uint32_t> places,
                                           std::uint32_t guess) const {
  NearestOnTriangle best;
  leaves_[place_[guess]].shape.offer(point_m, guess, best);
  for (const std::uint32_t place : places) {
    leaves_[place].shape.offer(point_m, leaves_[place].triangle, best);
  }
  return best;
}

void TriangleTree::near_box(const Eigen::AlignedBox3d& box,
                            const std::function<void(std::uint32_t)>& visit) const {
  std::vector<std::uint32_t> waiting = {0};
  while (!waiting.empty()) {
    const Node& node = nodes_[waiting.back()];
    waiting.pop_back();
    if ((node.low_m.array() > box.max().array()).any() ||
        (node.high_m.array() < box.min().array()).any()) {
      continue;
    }
    if (node.count == 0) {
      waiting.push_back(node.first);
      waiting.push_back(node.first + 1);
    }
    for (std::uint32_t i = 0; i < node.count; ++i) visit(leaves_[node.first + i].triangle);
  }
}

}  // namespace tenon
