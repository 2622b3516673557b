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

/// How far from a rectangle's corners it is cut off at 45 degrees, towards +y and towards -y.
struct Cuts {
  double front_m = 0.0;
  double back_m = 0.0;
};

/// A rectangle with its corners cut off, all of it larger by an offset.
Profile cut_rectangle(const Eigen::Vector2d& size_m, const Cuts& cuts, double offset_m = 0.0) {
  const double x_m = 0.5 * size_m.x() + offset_m;
  const double y_m = 0.5 * size_m.y() + offset_m;
  const double longer_m = offset_m * (2.0 - std::numbers::sqrt2);
  const double front_m = cuts.front_m + longer_m;
  const double back_m = cuts.back_m + longer_m;
  return {{x_m, back_m - y_m},   {x_m, y_m - front_m}, {x_m - front_m, y_m}, {front_m - x_m, y_m},
          {-x_m, y_m - front_m}, {-x_m, back_m - y_m}, {back_m - x_m, -y_m}, {x_m - back_m, -y_m}};
}

/// With each side in three.
Profile in_thirds(const Profile& profile) {
  Profile thirds;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Eigen::Vector2d& from = profile[i];
    const Eigen::Vector2d& to = profile[(i + 1) % profile.size()];
    for (int third = 0; third < 3; ++third) thirds.push_back(from + third * (to - from) / 3.0);
  }
  return thirds;
}

/// What goes into the inlet, larger by an offset: two of its corners say which way round.
Profile nose(double offset_m) { return cut_rectangle({24e-3, 16e-3}, {4.5e-3, 1e-3}, offset_m); }

/// Nose, grip, the ribs against kinking, and the beginning of the cable.
TriangleMesh connector_plug() {
  constexpr double kShoulder_m = 17e-3;
  constexpr double kBack_m = 36e-3;
  const auto grip = [](double offset_m) {
    return in_thirds(cut_rectangle({28e-3, 20e-3}, {5e-3, 3e-3}, offset_m));
  };
  const auto round = [&](double radius_m) {
    Profile profile = grip(0.0);
    for (Eigen::Vector2d& p : profile) p *= radius_m / p.norm();
    return profile;
  };
  std::vector<Ring3> rings = {
      {in_thirds(nose(-kChamfer_m)), 0.0}, {in_thirds(nose(0.0)), kChamfer_m},
      {in_thirds(nose(0.0)), kShoulder_m}, {grip(0.0), kShoulder_m},
      {grip(0.0), kBack_m - 4e-3},         {grip(-3e-3), kBack_m}};
  constexpr int kRibs = 4;
  for (int rib = 0; rib < kRibs; ++rib) {
    const double z_m = kBack_m + 4e-3 * rib;
    const double radius_m = 6e-3 - 0.5e-3 * rib;
    rings.insert(rings.end(), {{round(radius_m), z_m},
                               {round(radius_m), z_m + 2.5e-3},
                               {round(3.5e-3), z_m + 2.5e-3},
                               {round(3.5e-3), z_m + 4e-3}});
  }
  rings.push_back({round(3.5e-3), kBack_m + 40e-3});
  return lofted(rings);
}

/// A box with the collar of an inlet on its top.
TriangleMesh connector_socket() {
  constexpr double kPlay_m = 0.5e-3;  // on every side
  constexpr double kTop_m = 16.5e-3;
  constexpr double kPanel_m = 2e-3;
  constexpr double kWall_m = 3.5e-3;
  const Profile box = cut_rectangle({70e-3, 50e-3}, {3e-3, 3e-3});
  return lofted({{box, -15e-3},
                 {box, kPanel_m},
                 {nose(kWall_m), kPanel_m},
                 {nose(kWall_m), kTop_m},
                 {nose(kPlay_m + kChamfer_m), kTop_m},
                 {nose(kPlay_m), kTop_m - kChamfer_m},
                 {nose(kPlay_m), 0.0}});
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
  return {{"keyed_peg.stl", peg},
          {"keyed_socket.stl", socket},
          {"connector_plug.stl", connector_plug()},
          {"connector_socket.stl", connector_socket()}};
}

}  // namespace tenon::tests
