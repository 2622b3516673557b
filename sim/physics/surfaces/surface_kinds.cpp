#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <utility>

#include "shared/geometry/solid.h"
#include "sim/physics/surfaces/surface.h"

namespace tenon::sim {
namespace {

/// Edges are looked at in pieces of a fortieth of the shape, within these bounds.
constexpr double kPieceOfSize = 1.0 / 40.0;
constexpr double kPieceMin_m = 5e-4;
constexpr double kPieceMax_m = 5e-3;
/// How far a round edge's corners may leave its circle behind.
constexpr double kRoundness_m = 5e-6;
constexpr int kRoundSidesMin = 16;
constexpr int kRoundSidesMax = 256;

double piece_max_m(const Vector3& size_m) {
  return std::clamp(kPieceOfSize * size_m.maxCoeff(), kPieceMin_m, kPieceMax_m);
}

class BoxSurface final : public Surface {
 public:
  explicit BoxSurface(const Vector3& size_m) : half_m_(0.5 * size_m) {
    std::vector<Edge> edges;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double u : {-1.0, 1.0}) {
        for (const double v : {-1.0, 1.0}) {
          Vector3 from = half_m_;
          from[(axis + 1) % 3] *= u;
          from[(axis + 2) % 3] *= v;
          Vector3 to = from;
          from[axis] = -from[axis];
          Vector3 inwards = Vector3::Zero();
          inwards[(axis + 1) % 3] = -u;
          inwards[(axis + 2) % 3] = -v;
          edges.push_back({from, to, inwards});
        }
      }
    }
    sample(edges, piece_max_m(size_m));
  }

  [[nodiscard]] Place place(const Vector3& point_m, std::uint32_t /*guess*/) const override {
    const Vector3 off_m = point_m.cwiseAbs() - half_m_;
    Eigen::Index axis = 0;
    const double most_m = off_m.maxCoeff(&axis);
    if (most_m > 0.0) {
      const Vector3 nearest_m = point_m.cwiseMax(-half_m_).cwiseMin(half_m_);
      const double distance_m = (point_m - nearest_m).norm();
      return {distance_m, (point_m - nearest_m) / distance_m, nearest_m, 0};
    }
    const double side = point_m[axis] < 0.0 ? -1.0 : 1.0;
    Vector3 nearest_m = point_m;
    nearest_m[axis] = side * half_m_[axis];
    return {most_m, side * Vector3::Unit(axis), nearest_m, 0};
  }

 private:
  Vector3 half_m_;
};

class CylinderSurface final : public Surface {
 public:
  explicit CylinderSurface(const Vector3& size_m)
      : radius_m_(0.5 * size_m.x()), half_length_m_(0.5 * size_m.z()) {
    const double sides = std::numbers::pi / std::sqrt(2.0 * kRoundness_m / radius_m_);
    const int count =
        static_cast<int>(std::clamp(std::ceil(sides), 1.0 * kRoundSidesMin, 1.0 * kRoundSidesMax));
    const auto at = [&](int i, double z) {
      const double angle = 2.0 * std::numbers::pi * (i % count) / count;
      return Vector3(radius_m_ * std::cos(angle), radius_m_ * std::sin(angle), z);
    };
    std::vector<Edge> edges;
    for (int i = 0; i < count; ++i) {
      edges.push_back({at(i, -half_length_m_), at(i, half_length_m_), -at(i, 0.0) / radius_m_});
      const Vector3 amid = 0.5 * (at(i, 0.0) + at(i + 1, 0.0));
      for (const double side : {-1.0, 1.0}) {
        const double z = side * half_length_m_;
        edges.push_back({at(i, z), at(i + 1, z), -amid.normalized() - side * Vector3::UnitZ()});
      }
    }
    sample(edges, piece_max_m(size_m));
  }

  [[nodiscard]] Place place(const Vector3& point_m, std::uint32_t /*guess*/) const override {
    const double from_axis_m = point_m.head<2>().norm();
    const Vector3 out = from_axis_m > 0.0
                            ? Vector3(point_m.x() / from_axis_m, point_m.y() / from_axis_m, 0.0)
                            : Vector3::UnitX();
    const Vector3 up(0.0, 0.0, point_m.z() < 0.0 ? -1.0 : 1.0);
    const double beside_m = from_axis_m - radius_m_;
    const double above_m = std::abs(point_m.z()) - half_length_m_;
    if (beside_m > 0.0 && above_m > 0.0) {
      const Vector3 off_m = beside_m * out + above_m * up;
      const double distance_m = off_m.norm();
      return {distance_m, off_m / distance_m, point_m - off_m, 0};
    }
    const bool side = beside_m > above_m;
    const double distance_m = side ? beside_m : above_m;
    const Vector3 outwards = side ? out : up;
    return {distance_m, outwards, point_m - distance_m * outwards, 0};
  }

 private:
  double radius_m_;
  double half_length_m_;
};

class SolidSurface final : public Surface {
 public:
  SolidSurface(std::shared_ptr<const Solid> solid, MeshDistances distances)
      : solid_(std::move(solid)), sampled_(distances == MeshDistances::kSampled) {
    std::vector<Edge> edges;
    const std::vector<Vector3>& points_m = solid_->mesh().points_m;
    for (const Solid::Edge& edge : solid_->convex_edges()) {
      edges.push_back({points_m[edge.from], points_m[edge.to], edge.inwards});
    }
    sample(edges, piece_max_m(solid_->size_m()));
  }

  [[nodiscard]] Place place(const Vector3& point_m, std::uint32_t guess) const override {
    return of_solid(sampled_ ? solid_->sampled_place(point_m, guess)
                             : solid_->place(point_m, guess));
  }

  [[nodiscard]] Place next_place(const Vector3& point_m, Track& track) const override {
    Place found = of_solid(sampled_ ? solid_->sampled_place(point_m, track.guess)
                                    : solid_->place(point_m, track.guess, track.near));
    track.guess = found.guess;
    return found;
  }

  [[nodiscard]] bool exact() const override { return !sampled_; }

  [[nodiscard]] std::optional<double> distance_at_least_m(const Vector3& point_m) const override {
    if (sampled_) return std::nullopt;
    return solid_->distance_at_least_m(point_m);
  }

 private:
  [[nodiscard]] static Place of_solid(const Solid::Place& found) {
    return {found.distance_m, found.outwards, found.nearest_m, found.triangle};
  }

  std::shared_ptr<const Solid> solid_;
  bool sampled_;
};

/// Every thread and every pair of shapes asks for the surface of the same body: it is made once for
/// as long as somebody has it.
std::shared_ptr<const Surface> surface_of_solid(const std::shared_ptr<const Solid>& solid,
                                                MeshDistances distances) {
  static std::mutex mutex;
  static std::map<std::pair<const Solid*, MeshDistances>, std::weak_ptr<const Surface>> made;
  const std::lock_guard lock(mutex);
  // A surface keeps its body: one that is still there is of no other at the same address.
  if (auto known = made[{solid.get(), distances}].lock()) return known;
  std::erase_if(made, [](const auto& one) { return one.second.expired(); });
  auto surface = std::make_shared<const SolidSurface>(solid, distances);
  made[{solid.get(), distances}] = surface;
  return surface;
}

}  // namespace

std::shared_ptr<const Surface> surface_of(const Shape& shape, MeshDistances distances) {
  switch (shape.kind) {
    case Shape::Kind::kBox:
      return std::make_shared<BoxSurface>(shape.size_m);
    case Shape::Kind::kCylinder:
      return std::make_shared<CylinderSurface>(shape.size_m);
    case Shape::Kind::kSolid:
      return surface_of_solid(shape.solid, distances);
  }
  assert(false);
  return nullptr;
}

}  // namespace tenon::sim
