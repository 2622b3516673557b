#include "tests/solids/fcl_witness.h"

#include <fcl/fcl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace tenon::tests {
namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;

fcl::Transform3d transform_of(const Pose& pose) {
  fcl::Transform3d transform = fcl::Transform3d::Identity();
  transform.linear() = pose.orientation.toRotationMatrix();
  transform.translation() = pose.position_m;
  return transform;
}

/// Points that are the same become one.
void drop_repeated(std::vector<Vector3>& points_m) {
  const auto less = [](const Vector3& a, const Vector3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::sort(points_m.begin(), points_m.end(), less);
  points_m.erase(std::unique(points_m.begin(), points_m.end()), points_m.end());
}

std::shared_ptr<Model> model_of(const TriangleMesh& mesh) {
  auto model = std::make_shared<Model>();
  model->beginModel();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto corners_m = mesh.corners_m(i);
    model->addTriangle(corners_m[0], corners_m[1], corners_m[2]);
  }
  model->endModel();
  return model;
}

/// Of the sphere around a point that a triangle hides (van Oosterom and Strackee 1983), halved.
double half_solid_angle(const std::array<Vector3, 3>& corners_m, const Vector3& point_m) {
  const Vector3 a = corners_m[0] - point_m;
  const Vector3 b = corners_m[1] - point_m;
  const Vector3 c = corners_m[2] - point_m;
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  return std::atan2(a.dot(b.cross(c)),
                    la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

struct FclWitness::Body {
  explicit Body(const TriangleMesh& of) : mesh(of), model(model_of(of)), object(model) {
    for (const Vector3& point_m : of.points_m) box.extend(point_m);
  }

  [[nodiscard]] bool has_inside(const Vector3& point_m) const {
    if (!box.contains(point_m)) return false;
    double sum = 0.0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      sum += half_solid_angle(mesh.corners_m(i), point_m);
    }
    return sum > std::numbers::pi;  // half of one turn around; outside it is 0
  }

  /// How deep a point is in it, 0 outside, if that is more than some depth; else anything below.
  [[nodiscard]] double depth_m(const Vector3& point_m, double least_m) const {
    static const auto kPoint = std::make_shared<fcl::Sphered>(1e-9);
    const fcl::CollisionObjectd point(kPoint, Eigen::Matrix3d::Identity(), point_m);
    const fcl::DistanceRequestd request(true);
    fcl::DistanceResultd result;
    const double away_m = fcl::distance(&point, &object, request, result);
    if (away_m <= least_m) return 0.0;
    // Beyond a face the side is plain; beyond an edge or a corner the winding number tells.
    const auto corners_m = mesh.corners_m(static_cast<std::size_t>(std::max(result.b1, result.b2)));
    const Vector3 normal =
        (corners_m[1] - corners_m[0]).cross(corners_m[2] - corners_m[0]).normalized();
    const double height_m = normal.dot(point_m - corners_m[0]);
    const bool over_face = std::abs(std::abs(height_m) - away_m) < 1e-12;
    const bool inside = over_face ? height_m < 0.0 : has_inside(point_m);
    return inside ? away_m : 0.0;
  }

  /// Of the deepest of some points.
  [[nodiscard]] double depth_m(const std::vector<Vector3>& points_m) const {
    double deepest_m = 0.0;
    for (const Vector3& point_m : points_m) {
      deepest_m = std::max(deepest_m, depth_m(point_m, std::max(deepest_m, kNegligible_m)));
    }
    return deepest_m;
  }

  /// Points of a triangle's edges near a place.
  void add_points(std::size_t triangle, const Vector3& near_m,
                  std::vector<Vector3>& points_m) const {
    const auto corners_m = mesh.corners_m(triangle);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3 from_m = corners_m[i];
      const Vector3 way_m = corners_m[(i + 1) % 3] - from_m;
      const auto pieces = static_cast<int>(std::ceil(way_m.norm() / kSpacing_m));
      for (int k = 0; k < pieces; ++k) {
        const Vector3 point_m = from_m + way_m * (static_cast<double>(k) / pieces);
        if ((point_m - near_m).norm() < kAround_m) points_m.push_back(point_m);
      }
    }
  }

  TriangleMesh mesh;
  std::shared_ptr<Model> model;
  fcl::CollisionObjectd object;
  Eigen::AlignedBox3d box;
};

FclWitness::FclWitness(const TriangleMesh& held, const TriangleMesh& environment)
    : held_(std::make_unique<Body>(held)), environment_(std::make_unique<Body>(environment)) {}

FclWitness::~FclWitness() = default;

FclWitness::Opinion FclWitness::at(const Pose& X_EH) const {
  const fcl::Transform3d X = transform_of(X_EH);
  fcl::CollisionObjectd held = held_->object;
  held.setTransform(X);
  constexpr std::size_t kContactsMost = 200;
  const fcl::CollisionRequestd request(kContactsMost, true);
  fcl::CollisionResultd result;
  fcl::collide(&held, &environment_->object, request, result);
  if (!result.isCollision()) {
    const bool within = environment_->has_inside(X * held_->mesh.points_m.front()) ||
                        held_->has_inside(X.inverse() * environment_->mesh.points_m.front());
    return {false, within ? std::numeric_limits<double>::infinity() : 0.0};
  }
  std::vector<Vector3> of_held_m;
  std::vector<Vector3> of_environment_m;
  std::vector<fcl::Contactd> contacts;
  result.getContacts(contacts);
  for (const fcl::Contactd& contact : contacts) {
    held_->add_points(static_cast<std::size_t>(contact.b1), X.inverse() * contact.pos, of_held_m);
    environment_->add_points(static_cast<std::size_t>(contact.b2), contact.pos, of_environment_m);
  }
  drop_repeated(of_held_m);
  drop_repeated(of_environment_m);
  for (Vector3& point_m : of_held_m) point_m = X * point_m;
  for (Vector3& point_m : of_environment_m) point_m = X.inverse() * point_m;
  return {true, std::max(environment_->depth_m(of_held_m), held_->depth_m(of_environment_m))};
}

}  // namespace tenon::tests
