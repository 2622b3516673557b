#include "sim/physics/surfaces/surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace tenon::sim {
namespace {

constexpr std::uint32_t kLeafMax = 2;

}  // namespace

void Surface::sample(const std::vector<Edge>& edges, double piece_max_m) {
  std::map<std::tuple<double, double, double>, std::uint32_t> known;
  const auto index_of = [&](const Vector3& p) {
    const auto next = static_cast<std::uint32_t>(points_m_.size());
    const auto [at, fresh] = known.try_emplace({p.x(), p.y(), p.z()}, next);
    if (fresh) points_m_.push_back(p);
    return at->second;
  };
  for (const Edge& edge : edges) {
    const double length_m = (edge.to_m - edge.from_m).norm();
    const int count = std::max(1, static_cast<int>(std::ceil(length_m / piece_max_m)));
    std::uint32_t from = index_of(edge.from_m);
    for (int i = 1; i <= count; ++i) {
      const double part = static_cast<double>(i) / count;
      const std::uint32_t to =
          index_of(i == count ? edge.to_m : edge.from_m + part * (edge.to_m - edge.from_m));
      pieces_.push_back({from, to});
      inwards_.push_back(edge.inwards);
      from = to;
    }
  }
  leading_.resize(points_m_.size());
  for (const Piece& piece : pieces_) {
    const Vector3 way = (points_m_[piece.to] - points_m_[piece.from]).normalized();
    leading_[piece.from].push_back(way);
    leading_[piece.to].emplace_back(-way);
  }
  order_.resize(pieces_.size());
  std::iota(order_.begin(), order_.end(), 0U);
  if (pieces_.empty()) return;
  balls_.push_back({Vector3::Zero(), 0.0, 0, static_cast<std::uint32_t>(pieces_.size()), 0});
  for (std::size_t ball = 0; ball < balls_.size(); ++ball) split(ball);
}

bool Surface::foremost(std::uint32_t point, const Vector3& way) const {
  constexpr double kLevel = 0.035;  // 2 degrees
  return std::all_of(leading_[point].begin(), leading_[point].end(),
                     [&](const Vector3& leads) { return leads.dot(way) < kLevel; });
}

void Surface::split(std::size_t index) {
  const auto middle_m = [&](std::uint32_t piece) {
    return Vector3(0.5 * (points_m_[pieces_[piece].from] + points_m_[pieces_[piece].to]));
  };
  Ball& ball = balls_[index];
  const auto begin = order_.begin() + ball.first;
  Eigen::AlignedBox3d box;
  Eigen::AlignedBox3d middles;
  std::for_each(begin, begin + ball.count, [&](std::uint32_t piece) {
    box.extend(points_m_[pieces_[piece].from]);
    box.extend(points_m_[pieces_[piece].to]);
    middles.extend(middle_m(piece));
  });
  ball.centre_m = box.center();
  std::for_each(begin, begin + ball.count, [&](std::uint32_t piece) {
    for (const std::uint32_t point : {pieces_[piece].from, pieces_[piece].to}) {
      ball.radius_m = std::max(ball.radius_m, (points_m_[point] - ball.centre_m).norm());
    }
  });
  if (ball.count <= kLeafMax) return;
  Eigen::Index axis = 0;
  middles.sizes().maxCoeff(&axis);
  const std::uint32_t first = ball.first;
  const std::uint32_t count = ball.count;
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    const double at_a = middle_m(a)[axis];
    const double at_b = middle_m(b)[axis];
    return at_a != at_b ? at_a < at_b : a < b;
  });
  ball.child = static_cast<std::uint32_t>(balls_.size());
  balls_.push_back({Vector3::Zero(), 0.0, first, half, 0});
  balls_.push_back({Vector3::Zero(), 0.0, first + half, count - half, 0});
}

}  // namespace tenon::sim
