#include "planner/new_task/solid_gap.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tenon::planner {
namespace {

// Edges are looked at this often along a solid's longest side.
constexpr double kPlacesASide = 60.0;

std::vector<Vector3> places_on(const Solid& solid) {
  const double apart_m = solid.size_m().maxCoeff() / kPlacesASide;
  const std::vector<Vector3>& corners_m = solid.mesh().points_m;
  std::vector<Vector3> places_m;
  std::vector<bool> taken(corners_m.size(), false);
  for (const Solid::Edge& edge : solid.convex_edges()) {
    const Vector3 way_m = corners_m[edge.to] - corners_m[edge.from];
    const int pieces = static_cast<int>(std::ceil(way_m.norm() / apart_m));
    for (int i = 1; i < pieces; ++i) {
      places_m.emplace_back(corners_m[edge.from] + way_m * i / pieces);
    }
    for (const std::uint32_t corner : {edge.from, edge.to}) {
      if (!taken[corner]) places_m.push_back(corners_m[corner]);
      taken[corner] = true;
    }
  }
  return places_m;
}

/// The least distance of the points from a solid, if it is less than `least_m`.
double least_of(const Solid& solid, const std::vector<Vector3>& points_m, const Pose& X_SP,
                double least_m) {
  const Vector3 half_m = 0.5 * solid.size_m();
  std::uint32_t guess = 0;
  for (const Vector3& point : points_m) {
    const Vector3 point_m = X_SP.position_m + X_SP.orientation * point;
    if ((point_m.cwiseAbs() - half_m).maxCoeff() >= least_m) continue;
    const Solid::Place place = solid.place(point_m, guess);
    guess = place.triangle;
    least_m = std::min(least_m, place.distance_m);
  }
  return least_m;
}

}  // namespace

SolidGap::SolidGap(std::shared_ptr<const Solid> held, std::shared_ptr<const Solid> environment)
    : held_(std::move(held)),
      environment_(std::move(environment)),
      held_points_m_(places_on(*held_)),
      environment_points_m_(places_on(*environment_)) {}

double SolidGap::gap_m(const Pose& X_EH, double far_m) const {
  const double least_m = least_of(*environment_, held_points_m_, X_EH, far_m);
  return least_of(*held_, environment_points_m_, inverse(X_EH), least_m);
}

}  // namespace tenon::planner
