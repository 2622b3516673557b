#include "planner/new_task/solid_gap.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "shared/geometry/common_depth.h"

namespace tenon::planner {
namespace {

// Edges are looked at this often along a solid's longest side.
constexpr double kPlacesASide = 60.0;

using EdgePoint = SolidGap::EdgePoint;

std::vector<EdgePoint> points_on(const Solid& solid) {
  const double apart_m = solid.size_m().maxCoeff() / kPlacesASide;
  const std::vector<Vector3>& corners_m = solid.mesh().points_m;
  std::vector<EdgePoint> points;
  std::vector<bool> taken(corners_m.size(), false);
  for (const Solid::Edge& edge : solid.convex_edges()) {
    const Vector3 way_m = corners_m[edge.to] - corners_m[edge.from];
    const int pieces = std::max(2, static_cast<int>(std::ceil(way_m.norm() / apart_m)));
    for (int i = 1; i < pieces; ++i) {
      points.push_back({corners_m[edge.from] + way_m * i / pieces, edge.inwards});
    }
    for (const std::uint32_t corner : {edge.from, edge.to}) {
      if (!taken[corner]) points.push_back({corners_m[corner], Vector3::Zero()});
      taken[corner] = true;
    }
  }
  return points;
}

/// The least distance of the points of one solid from another, if it is less than `least_m`.
double least_of(const Solid& own, const Solid& other, const std::vector<EdgePoint>& points,
                const Pose& X_SP, double least_m) {
  const Vector3 half_m = 0.5 * other.size_m();
  std::uint32_t guess = 0;
  const auto other_m = [&](const Vector3& point) {
    const Solid::Place place = other.place(X_SP.position_m + X_SP.orientation * point, guess);
    guess = place.triangle;
    return place.distance_m;
  };
  const auto own_m = [&](const Vector3& point) { return own.place(point).distance_m; };
  for (const EdgePoint& point : points) {
    const Vector3 point_m = X_SP.position_m + X_SP.orientation * point.at_m;
    const double outside_m = (point_m.cwiseAbs() - half_m).maxCoeff();
    if (outside_m >= std::max(least_m, kDrawnTo_m)) continue;
    const double distance_m = other_m(point.at_m);
    least_m = std::min(least_m, distance_m);
    if (distance_m > kDrawnTo_m || point.inwards.isZero(0.0)) continue;
    const double depth_m = common_depth_m(point.at_m, point.inwards, own_m, other_m);
    if (depth_m > 0.0) least_m = std::min(least_m, -depth_m);
  }
  return least_m;
}

}  // namespace

SolidGap::SolidGap(std::shared_ptr<const Solid> held, std::shared_ptr<const Solid> environment)
    : held_(std::move(held)),
      environment_(std::move(environment)),
      held_points_(points_on(*held_)),
      environment_points_(points_on(*environment_)) {}

double SolidGap::gap_m(const Pose& X_EH, double far_m) const {
  const double least_m = least_of(*held_, *environment_, held_points_, X_EH, far_m);
  return least_of(*environment_, *held_, environment_points_, inverse(X_EH), least_m);
}

}  // namespace tenon::planner
