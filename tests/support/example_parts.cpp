#include "tests/support/example_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/meshes.h"

namespace tenon::tests {
namespace {

constexpr double kChamfer_m = 1e-3;

/// A circle with a key in the direction of x, all of it larger by an offset.
Profile keyed(double offset_m) {
  constexpr double kRadius_m = 10e-3;
  constexpr double kKeyReach_m = 13e-3;
  constexpr double kKeyWidth_m = 6e-3;
  constexpr int kSides = 60;
  const double radius_m = kRadius_m + offset_m;
  const double half_m = 0.5 * kKeyWidth_m + offset_m;
  const double first = std::asin(half_m / radius_m);
  Profile profile = {{kKeyReach_m + offset_m, -half_m}, {kKeyReach_m + offset_m, half_m}};
  for (int i = 0; i <= kSides; ++i) {
    const double angle = first + 2.0 * (std::numbers::pi - first) * i / kSides;
    profile.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle));
  }
  return profile;
}

/// A square around the origin, with a corner in the direction of each of the profile's.
Profile square_around(const Profile& profile, double width_m) {
  Profile square;
  for (const Eigen::Vector2d& p : profile) {
    square.push_back(p * (0.5 * width_m / std::max(std::abs(p.x()), std::abs(p.y()))));
  }
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      const Eigen::Vector2d corner_m(x * width_m, y * width_m);
      *std::min_element(square.begin(), square.end(), [&](const auto& a, const auto& b) {
        return (a - corner_m).norm() < (b - corner_m).norm();
      }) = corner_m;
    }
  }
  return square;
}

}  // namespace

std::map<std::string, TriangleMesh> example_parts() {
  const TriangleMesh peg =
      lofted({{keyed(-kChamfer_m), 0.0}, {keyed(0.0), kChamfer_m}, {keyed(0.0), 50e-3}});

  constexpr double kPlay_m = 0.5e-3;  // on every side
  constexpr double kTop_m = 30e-3;
  const Profile block = square_around(keyed(kPlay_m), 60e-3);
  const TriangleMesh socket = lofted({{block, -10e-3},
                                      {block, kTop_m},
                                      {keyed(kPlay_m + kChamfer_m), kTop_m},
                                      {keyed(kPlay_m), kTop_m - kChamfer_m},
                                      {keyed(kPlay_m), 0.0}});
  return {{"keyed_peg.stl", peg}, {"keyed_socket.stl", socket}};
}

}  // namespace tenon::tests
