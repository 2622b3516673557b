#include "sim/evaluation/outline.h"

#include <algorithm>
#include <utility>

#include "shared/drawing/prism.h"

namespace tenon::sim {
namespace {

drawing::Prism prism_of(const Shape& shape, const Pose& frame) {
  constexpr int kRoundSides = 32;
  return drawing::prism_of(shape, frame, kRoundSides);
}

std::pair<double, double> depth_of(const Shape& shape, const Pose& frame,
                                   const drawing::View& view) {
  std::pair<double, double> range{1e9, -1e9};
  for (const Vector3& corner : prism_of(shape, frame).corners_m) {
    range.first = std::min(range.first, corner[view.along]);
    range.second = std::max(range.second, corner[view.along]);
  }
  return range;
}

}  // namespace

std::vector<drawing::Point> outline(const Shape& shape, const Pose& frame,
                                    const drawing::View& view) {
  std::vector<drawing::Point> points;
  for (const Vector3& corner : prism_of(shape, frame).corners_m) points.push_back(view.mm(corner));
  return drawing::hull_of(std::move(points));
}

bool share_depth(const Shape& a, const Pose& frame_a, const Shape& b, const Pose& frame_b,
                 const drawing::View& view) {
  const auto [a_low, a_high] = depth_of(a, frame_a, view);
  const auto [b_low, b_high] = depth_of(b, frame_b, view);
  return a_low < b_high && b_low < a_high;
}

}  // namespace tenon::sim
