#include "planner/search/touch_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "shared/geometry/solid.h"

namespace tenon::planner {
namespace {

// Faces against a push: within two degrees.
constexpr double kFacing = 0.9994;
// A round side: as far as it slopes by up to 25 degrees.
constexpr double kRound = 0.906;
// Of one flat patch: no farther apart along the push.
constexpr double kFlat_m = 1e-5;
// The most patches of a solid that are worth a push each: of all, and of those that a push from
// outside meets first. The largest faces of a housing may all be inside of it.
constexpr std::size_t kMaxPatches = 3;
constexpr std::size_t kMaxOuterPatches = 3;
constexpr std::size_t kMaxRoundPatches = 2;
// Of so many of the largest it is asked whether anything stands before them.
constexpr std::size_t kMaxAsked = 16;
// Places on a patch are looked for on a grid of so many by so many.
constexpr int kGrid = 24;

using Flat = std::array<double, 2>;

/// A triangle or an edge of a patch, seen along the push.
using FlatTriangle = std::array<Flat, 3>;
using FlatEdge = std::array<Flat, 2>;

struct Patch {
  std::vector<FlatTriangle> triangles;
  std::vector<FlatEdge> rim;
  double along_m = 0.0;  ///< of what a push meets first
  double deep_m = 0.0;   ///< how far the rest is behind that
  double area_m2 = 0.0;
};

double cross(const Flat& o, const Flat& a, const Flat& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

double area_m2(const FlatTriangle& t) { return 0.5 * std::abs(cross(t[0], t[1], t[2])); }

bool inside(const FlatTriangle& t, const Flat& p) {
  const double a = cross(t[0], t[1], p);
  const double b = cross(t[1], t[2], p);
  const double c = cross(t[2], t[0], p);
  return (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0);
}

double distance(const FlatEdge& e, const Flat& p) {
  const double u = e[1][0] - e[0][0];
  const double v = e[1][1] - e[0][1];
  const double square = u * u + v * v;
  const double along =
      square > 0.0 ? std::clamp(((p[0] - e[0][0]) * u + (p[1] - e[0][1]) * v) / square, 0.0, 1.0)
                   : 0.0;
  return std::hypot(e[0][0] + along * u - p[0], e[0][1] + along * v - p[1]);
}

enum class Side : std::uint8_t { kFlat, kRound };

/// Of a solid's triangles those that face against a push, joined where they share an edge.
class Patches {
 public:
  Patches(const Shape& shape, int axis, int sign, Side side)
      : solid_(shape.solid->mesh()), axis_(axis), sign_(sign), side_(side) {
    for (const Vector3& point_m : solid_.points_m) {
      points_m_.push_back(shape.pose.position_m + shape.pose.orientation * point_m);
    }
    for (const Triangle& triangle : solid_.triangles) {
      if (faces(triangle)) triangles_.push_back(triangle);
    }
    patch_of_.resize(triangles_.size());
    std::iota(patch_of_.begin(), patch_of_.end(), std::size_t{0});
    join();
  }

  /// The largest first.
  [[nodiscard]] std::vector<Patch> take() {
    std::map<std::size_t, Patch> patches;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      Patch& patch = patches[root(i)];
      const FlatTriangle& flat =
          patch.triangles.emplace_back(FlatTriangle{seen(i, 0), seen(i, 1), seen(i, 2)});
      if (patch.triangles.size() == 1) patch.along_m = corner_m(i, 0)[axis_];
      patch.area_m2 += area_m2(flat);
      add_depth(i, patch);
    }
    for (const auto& [edge, sides] : edges_) {
      if (sides.size() > 1 && root(sides.front()) == root(sides.back())) continue;
      for (const std::size_t side : sides) {
        patches[root(side)].rim.push_back({seen(edge.first), seen(edge.second)});
      }
    }
    std::vector<Patch> largest;
    largest.reserve(patches.size());
    for (auto& [first, patch] : patches) largest.push_back(std::move(patch));
    std::stable_sort(largest.begin(), largest.end(),
                     [](const Patch& a, const Patch& b) { return a.area_m2 > b.area_m2; });
    return side_ == Side::kFlat ? worth_a_push(std::move(largest)) : round(std::move(largest));
  }

 private:
  void add_depth(std::size_t triangle, Patch& patch) const {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const double behind_m = sign_ * (corner_m(triangle, corner)[axis_] - patch.along_m);
      if (behind_m < 0.0) patch.along_m += sign_ * behind_m;
      patch.deep_m = behind_m < 0.0 ? patch.deep_m - behind_m : std::max(patch.deep_m, behind_m);
    }
  }

  /// The first few that nothing stands before, and that are not flat.
  [[nodiscard]] std::vector<Patch> round(std::vector<Patch> largest) const {
    std::vector<Patch> taken;
    for (std::size_t i = 0; i < std::min(largest.size(), kMaxAsked); ++i) {
      if (taken.size() == kMaxRoundPatches) break;
      if (largest[i].deep_m < kFlat_m || !is_outer(largest[i])) continue;
      taken.push_back(std::move(largest[i]));
    }
    return taken;
  }

  /// Of patches, the largest first, the first few and the first few outer ones, in that order.
  [[nodiscard]] std::vector<Patch> worth_a_push(std::vector<Patch> largest) const {
    std::vector<Patch> taken;
    std::size_t outer = 0;
    for (std::size_t i = 0; i < std::min(largest.size(), kMaxAsked); ++i) {
      const bool one_more = outer < kMaxOuterPatches && is_outer(largest[i]);
      outer += one_more;
      if (i < kMaxPatches || one_more) taken.push_back(std::move(largest[i]));
    }
    return taken;
  }

  /// Nothing of the solid stands before the middle of the patch's largest triangle.
  [[nodiscard]] bool is_outer(const Patch& patch) const {
    const FlatTriangle& t = *std::max_element(
        patch.triangles.begin(), patch.triangles.end(),
        [](const FlatTriangle& a, const FlatTriangle& b) { return area_m2(a) < area_m2(b); });
    const Flat middle = {(t[0][0] + t[1][0] + t[2][0]) / 3.0, (t[0][1] + t[1][1] + t[2][1]) / 3.0};
    return std::none_of(
        solid_.triangles.begin(), solid_.triangles.end(), [&](const Triangle& other) {
          const FlatTriangle flat = {seen(other[0]), seen(other[1]), seen(other[2])};
          return area_m2(flat) > 0.0 && inside(flat, middle) &&
                 sign_ * (patch.along_m - along_m(other, flat, middle)) > kFlat_m;
        });
  }

  /// Where a line along the push through a place meets a triangle's plane.
  [[nodiscard]] double along_m(const Triangle& triangle, const FlatTriangle& flat,
                               const Flat& place) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double part = cross(place, flat[(i + 1) % 3], flat[(i + 2) % 3]);
      sum += part * points_m_[triangle[i]][axis_];
    }
    return sum / cross(flat[0], flat[1], flat[2]);
  }

  [[nodiscard]] bool faces(const Triangle& t) const {
    const Vector3 normal =
        (points_m_[t[1]] - points_m_[t[0]]).cross(points_m_[t[2]] - points_m_[t[0]]);
    return -sign_ * normal[axis_] > (side_ == Side::kFlat ? kFacing : kRound) * normal.norm();
  }

  void join() {
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const auto [low, high] =
            std::minmax(triangles_[i][corner], triangles_[i][(corner + 1) % 3]);
        edges_[{low, high}].push_back(i);
      }
    }
    for (const auto& [edge, sides] : edges_) {
      for (const std::size_t side : sides) {
        const double apart_m = corner_m(side, 0)[axis_] - corner_m(sides.front(), 0)[axis_];
        if (side_ == Side::kFlat && std::abs(apart_m) >= kFlat_m) continue;
        patch_of_[root(side)] = root(sides.front());
      }
    }
  }

  [[nodiscard]] std::size_t root(std::size_t i) const {
    while (patch_of_[i] != i) i = patch_of_[i];
    return i;
  }
  [[nodiscard]] const Vector3& corner_m(std::size_t triangle, std::size_t corner) const {
    return points_m_[triangles_[triangle][corner]];
  }
  [[nodiscard]] Flat seen(std::uint32_t point) const {
    return {points_m_[point][(axis_ + 1) % 3], points_m_[point][(axis_ + 2) % 3]};
  }
  [[nodiscard]] Flat seen(std::size_t triangle, std::size_t corner) const {
    return seen(triangles_[triangle][corner]);
  }

  const TriangleMesh& solid_;
  int axis_;
  int sign_;
  Side side_;
  std::vector<Vector3> points_m_;
  std::vector<Triangle> triangles_;
  std::vector<std::size_t> patch_of_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> edges_;
};

Eigen::AlignedBox3d box_around(const Flat& low, const Flat& high, int axis, double along_m) {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  Eigen::AlignedBox3d box{Vector3::Constant(along_m), Vector3::Constant(along_m)};
  box.min()[u] = low[0];
  box.max()[u] = high[0];
  box.min()[v] = low[1];
  box.max()[v] = high[1];
  return box;
}

/// On a patch; where its rim is far, or far enough and near another place.
TouchPlace place_on(const Patch& patch, int axis, double enough_m, const Vector3& near_m) {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  Flat low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Flat high{-low[0], -low[1]};
  for (const FlatTriangle& triangle : patch.triangles) {
    for (const Flat& corner : triangle) {
      for (std::size_t i = 0; i < 2; ++i) {
        low[i] = std::min(low[i], corner[i]);
        high[i] = std::max(high[i], corner[i]);
      }
    }
  }
  TouchPlace best;
  best.area_m2 = patch.area_m2;
  best.to_rim_m = -1.0;
  best.side_m = box_around(low, high, axis, patch.along_m);
  double best_off_m = 0.0;
  const auto look_at = [&](const Flat& p) {
    if (std::none_of(patch.triangles.begin(), patch.triangles.end(),
                     [&](const FlatTriangle& t) { return inside(t, p); })) {
      return;
    }
    double to_rim_m = enough_m;
    for (const FlatEdge& edge : patch.rim) to_rim_m = std::min(to_rim_m, distance(edge, p));
    const double off_m = std::hypot(p[0] - near_m[u], p[1] - near_m[v]);
    if (std::pair(to_rim_m, -off_m) <= std::pair(best.to_rim_m, -best_off_m)) return;
    best.to_rim_m = to_rim_m;
    best_off_m = off_m;
    best.at_m[axis] = patch.along_m;
    best.at_m[u] = p[0];
    best.at_m[v] = p[1];
  };
  for (int i = 0; i < kGrid; ++i) {
    for (int j = 0; j < kGrid; ++j) {
      look_at({low[0] + (high[0] - low[0]) * (i + 0.5) / kGrid,
               low[1] + (high[1] - low[1]) * (j + 0.5) / kGrid});
    }
  }
  if (best.to_rim_m < 0.0) {
    const FlatTriangle& t = patch.triangles.front();
    look_at({(t[0][0] + t[1][0] + t[2][0]) / 3.0, (t[0][1] + t[1][1] + t[2][1]) / 3.0});
  }
  return best;
}

/// Of the box around a shape, along the task's axes.
TouchPlace side_of(const Shape& shape, int axis, int sign) {
  Vector3 half_m = Vector3::Zero();
  for (int i = 0; i < 3; ++i) {
    half_m += 0.5 * shape.size_m[i] * (shape.pose.orientation * Vector3::Unit(i)).cwiseAbs();
  }
  TouchPlace side;
  side.at_m = shape.pose.position_m;
  side.at_m[axis] -= sign * half_m[axis];
  Vector3 across_m = half_m;
  across_m[axis] = 0.0;
  side.side_m = {side.at_m - across_m, side.at_m + across_m};
  const double u_m = half_m[(axis + 1) % 3];
  const double v_m = half_m[(axis + 2) % 3];
  side.area_m2 = 4.0 * u_m * v_m;
  side.to_rim_m = std::min(u_m, v_m);
  return side;
}

}  // namespace

std::vector<TouchPlace> touch_places(const Shape& shape, int axis, int sign, double enough_m,
                                     const Vector3& near_m) {
  if (shape.kind != Shape::Kind::kSolid) return {side_of(shape, axis, sign)};
  std::vector<TouchPlace> places;
  for (const Patch& patch : Patches(shape, axis, sign, Side::kFlat).take()) {
    places.push_back(place_on(patch, axis, enough_m, near_m));
  }
  return places;
}

std::vector<TouchPlace> round_places(const Shape& shape, int axis, int sign,
                                     const Vector3& near_m) {
  std::vector<TouchPlace> places;
  if (shape.kind != Shape::Kind::kSolid) return places;
  constexpr double kAsFarAsCanBe_m = 1e3;
  for (const Patch& patch : Patches(shape, axis, sign, Side::kRound).take()) {
    places.push_back(place_on(patch, axis, kAsFarAsCanBe_m, near_m));
  }
  return places;
}

}  // namespace tenon::planner
