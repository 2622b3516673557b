// Many shapes that make up one face behave as one shape: as stiff, and without a crowd of contacts.

#include "sim/physics/contacts/contact_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "shared/task/ring.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "sim/physics/solver/ode_world.h"

namespace tenon::sim {
namespace {

dContactGeom point(const Vector3& position_m, const Vector3& normal, double depth_m = 1e-4) {
  dContactGeom point{};
  for (int axis = 0; axis < 3; ++axis) {
    point.pos[axis] = position_m[axis];
    point.normal[axis] = normal[axis];
  }
  point.depth = depth_m;
  return point;
}

TEST(ContactPoints, FewOfAFaceAllStay) {
  std::vector<dContactGeom> points;
  for (int i = 0; i < 5; ++i) points.push_back(point({0.01 * i, 0.0, 0.0}, Vector3::UnitZ()));
  for (int i = 0; i < 5; ++i) points.push_back(point({0.0, 0.01 * i, 0.0}, Vector3::UnitX()));
  thin_out(points);
  EXPECT_EQ(points.size(), 10U);
}

TEST(ContactPoints, OfACrowdTheHullAndTheDeepestStayInTheirOrder) {
  std::vector<dContactGeom> points;
  for (int x = -5; x <= 5; ++x) {
    for (int y = -5; y <= 5; ++y) {
      points.push_back(
          point({0.01 * x, 0.01 * y, 0.0}, Vector3::UnitZ(), x == 1 && y == 2 ? 2e-4 : 1e-4));
    }
  }
  thin_out(points);
  ASSERT_LE(points.size(), kPointsAFace);
  double lowest_m = 0.0;
  double highest_m = 0.0;
  double deepest_m = 0.0;
  for (const dContactGeom& p : points) {
    lowest_m = std::min(lowest_m, p.pos[0] + p.pos[1]);
    highest_m = std::max(highest_m, p.pos[0] - p.pos[1]);
    deepest_m = std::max(deepest_m, p.depth);
  }
  EXPECT_DOUBLE_EQ(lowest_m, -0.1);
  EXPECT_DOUBLE_EQ(highest_m, 0.1);
  EXPECT_EQ(deepest_m, 2e-4);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto place = [](const dContactGeom& p) { return std::pair(p.pos[0], p.pos[1]); };
    EXPECT_LT(place(points[i - 1]), place(points[i]));
  }
}

TEST(ContactPoints, FacesApartAreThinnedApart) {
  // The same normal, one face 20 mm above the other.
  std::vector<dContactGeom> points;
  for (int i = 0; i < 20; ++i) {
    points.push_back(point({0.001 * i, 0.0, 0.0}, Vector3::UnitZ()));
    points.push_back(point({0.001 * i, 0.0, 0.02}, Vector3::UnitZ()));
  }
  thin_out(points);
  std::size_t above = 0;
  for (const dContactGeom& p : points) above += p.pos[2] > 0.01;
  EXPECT_GE(above, 2U);
  EXPECT_GE(points.size() - above, 2U);
}

TEST(ContactPoints, OfAPartThatCannotRotateTheDeepestOfEachFaceStays) {
  std::vector<dContactGeom> points;
  for (int i = 0; i < 4; ++i) {
    const double depth_m = i == 2 ? 2e-4 : 1e-4;
    points.push_back(point({0.01 * i, 0.0, 0.0}, Vector3::UnitZ(), depth_m));
    points.push_back(point({0.0, 0.01 * i, 0.0}, Vector3::UnitX(), depth_m));
  }
  keep_deepest(points);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].normal[2], 1.0);
  EXPECT_EQ(points[0].pos[0], 0.02);
  EXPECT_EQ(points[1].normal[0], 1.0);
  EXPECT_EQ(points[1].pos[1], 0.02);
}

TEST(ContactPoints, StiffnessIsSharedAmongThoseThatPushTheSameWay) {
  const double diagonal = std::numbers::sqrt2 / 2.0;
  const std::vector<dContactGeom> points = {
      point({0.0, 0.0, 0.0}, Vector3::UnitZ()), point({0.1, 0.0, 0.0}, Vector3::UnitZ()),
      point({0.0, 0.0, 0.0}, -Vector3::UnitZ()), point({0.0, 0.0, 0.0}, Vector3::UnitX()),
      point({0.0, 0.0, 0.0}, Vector3(0.0, diagonal, diagonal))};
  EXPECT_NEAR(share(points, 0), 1.0 / 2.5, 1e-12);
  EXPECT_NEAR(share(points, 1), 1.0 / 2.5, 1e-12);
  EXPECT_NEAR(share(points, 2), 1.0, 1e-12);
  EXPECT_NEAR(share(points, 3), 1.0, 1e-12);
  EXPECT_NEAR(share(points, 4), 1.0 / 2.0, 1e-12);
}

/// What points on the plane z = 0 push back with, of a spring of 1 N/m.
double force_N(const std::vector<double>& depths_m) {
  std::vector<dContactGeom> points;
  for (const double depth_m : depths_m)
    points.push_back(point(Vector3::Zero(), Vector3::UnitZ(), depth_m));
  double sum_N = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) sum_N += share(points, i) * depths_m[i];
  return sum_N;
}

TEST(ContactPoints, ATiltedFacesForceDoesNotJumpWhenAnotherCornerComesIntoReach) {
  // It stands on one edge; then its other edge begins to graze, and then goes on into the ground.
  const double on_edge_N = force_N({7e-5, 7e-5});
  EXPECT_NEAR(on_edge_N, 7e-5, 1e-12);
  EXPECT_NEAR(force_N({7e-5, 7e-5, 0.0, 0.0}), on_edge_N, 2e-3 * on_edge_N);
  EXPECT_NEAR(force_N({7e-5, 7e-5, 1e-6, 1e-6}), on_edge_N, 0.02 * on_edge_N);
  EXPECT_NEAR(force_N({7e-5, 7e-5, 7e-5, 7e-5}), on_edge_N, 1e-12);
}

TEST(ContactPoints, AForceDoesNotDependOnHowManyPointsStandForAnEdge) {
  EXPECT_NEAR(force_N({7e-5, 7e-5, 7e-5, 2e-6, 2e-6}), force_N({7e-5, 7e-5, 2e-6, 2e-6}),
              0.02 * 7e-5);
}

/// A cube pressed down on what is below z = 0; k_e 5e4 N/m.
RolloutResult pressed(const std::vector<Shape>& ground) {
  Task task;
  task.held = {{"cube", Shape::Kind::kBox, {0.04, 0.04, 0.04}, {{0.0, 0.0, 0.02}, {1, 0, 0, 0}}}};
  task.environment = ground;
  task.compliance.compliant_axes = 0b000111;
  MoveParameters move;
  move.compliance = task.compliance;
  move.displacement.z() = -0.05;
  Particle particle;
  particle.pose.position_m.z() = 0.02;
  return OdeRollout(task).simulate(particle, move, 2000, nullptr);
}

TEST(ContactPoints, AGroundOfManyBoxesIsAsStiffAsOneOfOne) {
  const Pose below = {{0.0, 0.0, -0.05}, Eigen::Quaterniond::Identity()};
  const RolloutResult one = pressed({{"slab", Shape::Kind::kBox, {0.4, 0.4, 0.1}, below}});
  ASSERT_TRUE(one.valid) << one.failure;
  ASSERT_EQ(one.move.outcome, Outcome::kContact);

  std::vector<Shape> tiles;
  for (const double x_m : {-0.1, 0.1}) {
    for (const double y_m : {-0.1, 0.1}) {
      const Pose at = {{x_m, y_m, -0.05}, Eigen::Quaterniond::Identity()};
      tiles.push_back({"tile", Shape::Kind::kBox, {0.2, 0.2, 0.1}, at});
    }
  }
  Ring ring;
  ring.inner_diameter_m = 0.02;
  ring.outer_diameter_m = 0.4;
  ring.length_m = 0.1;
  ring.pose = below;
  for (const std::vector<Shape>& ground : {tiles, boxes_of(ring)}) {
    const RolloutResult many = pressed(ground);
    ASSERT_TRUE(many.valid) << many.failure;
    EXPECT_EQ(many.move.outcome, Outcome::kContact);
    EXPECT_NEAR(many.move.pose.position_m.z(), one.move.pose.position_m.z(), 1e-6);
    EXPECT_NEAR(many.move.peak_force_N, one.move.peak_force_N, 0.01 * one.move.peak_force_N);
  }
}

}  // namespace
}  // namespace tenon::sim
