// The points by which upright shapes turn each other, against where the shapes are.

#include "sim/physics/contacts/prism_manifold.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shared/base/random.h"
#include "sim/physics/contacts/prism_contact.h"
#include "sim/physics/solver/ode_world.h"

namespace tenon::sim {
namespace {

constexpr double kRounding_m = 1e-9;

Vector3 at(const dContactGeom& point) { return {point.pos[0], point.pos[1], point.pos[2]}; }
Vector3 normal(const dContactGeom& point) {
  return {point.normal[0], point.normal[1], point.normal[2]};
}

/// How far a place is outside of a shape; 0 within.
double outside_m(const Shape& shape, const Vector3& place_m) {
  const Vector3 p = compose(inverse(shape.pose), {place_m, {1, 0, 0, 0}}).position_m;
  const Vector3 half_m = 0.5 * shape.size_m;
  if (shape.kind == Shape::Kind::kBox) return (p.cwiseAbs() - half_m).maxCoeff();
  return std::max(p.head<2>().norm() - half_m.x(), std::abs(p.z()) - half_m.z());
}

struct HeldAndFixed {
  Shape held{"held", Shape::Kind::kBox, {0.1, 0.06, 0.2}, {}};
  Shape fixed{"fixed", Shape::Kind::kBox, {0.3, 0.2, 0.1}, {}};
};

/// Somewhere about each other's sides or ends, a little deep or off, all of it turned.
void place(Random& random, HeldAndFixed& pair) {
  const auto within = [&](double low, double high) {
    return low + random.uniform() * (high - low);
  };
  const Pose all{{0.1, -0.2, 0.3}, rotation_of({0.3, 0.5, -0.2})};
  Pose held;
  held.orientation = rotation_of({0.0, 0.0, random.uniform() < 0.3 ? 0.0 : within(-3.0, 3.0)});
  const double side = random.uniform() < 0.5 ? 1.0 : -1.0;
  if (random.uniform() < 0.3) {
    const double sum_m = 0.5 * (pair.held.size_m.z() + pair.fixed.size_m.z());
    held.position_m = {within(-0.2, 0.2), within(-0.15, 0.15),
                       side * (sum_m + within(-1e-3, 1e-3))};
  } else {
    held.position_m = {within(-0.25, 0.25), side * within(0.08, 0.2), within(-0.14, 0.14)};
  }
  pair.held.pose = compose(all, held);
  pair.fixed.pose = all;
}

void expect_sound(HeldAndFixed pair, std::uint64_t seed) {
  const OdeWorld initialised;
  Random random(seed);
  int touching = 0;
  for (int i = 0; i < 3000; ++i) {
    place(random, pair);
    ShapeGeometry held(pair.held);
    ShapeGeometry fixed(pair.fixed);
    held.place({});
    fixed.place({});
    PairPoints buffer;
    const auto points = prism_manifold(held, fixed, buffer);
    const auto one = prism_contact(held, fixed);
    ASSERT_TRUE(points && one);
    EXPECT_EQ(points->empty(), one->depth < 0.0) << i << ": depth " << one->depth;
    if (points->empty()) continue;
    ++touching;
    double deepest_m = 0.0;
    for (const dContactGeom& point : *points) {
      deepest_m = std::max(deepest_m, 1.0 * point.depth);
      EXPECT_GT(normal(point).dot(normal(*one)), 1.0 - 1e-9);
      // Between the two faces: as deep in the one as it says, and no deeper than that off the
      // other.
      EXPECT_LT(outside_m(pair.held, at(point)), point.depth + kRounding_m) << i;
      EXPECT_LT(outside_m(pair.fixed, at(point)), point.depth + kRounding_m) << i;
    }
    EXPECT_NEAR(deepest_m, one->depth, 1e-9) << i;
  }
  EXPECT_GT(touching, 700);
}

TEST(PrismManifold, BoxesThatTurnAgainstEachOther) { expect_sound({}, 1); }

TEST(PrismManifold, ACylinderAndABox) {
  HeldAndFixed pair;
  pair.held = {"held", Shape::Kind::kCylinder, {0.06, 0.06, 0.1}, {}};
  expect_sound(pair, 2);
}

TEST(PrismManifold, AFlatFaceHasItsFourCornersAndATiltedOneItsDeepEdge) {
  const OdeWorld initialised;
  Shape wall{"wall", Shape::Kind::kBox, {0.1, 1.0, 0.4}, {{0.1, 0.0, 0.0}, {1, 0, 0, 0}}};
  Shape part{"part", Shape::Kind::kBox, {0.1, 0.1, 0.1}, {}};
  part.pose.position_m.x() = 1e-4;
  PairPoints buffer;
  const auto points_at = [&](double turned_rad) {
    part.pose.orientation = rotation_of({0.0, 0.0, turned_rad});
    ShapeGeometry held(part);
    ShapeGeometry fixed(wall);
    held.place({});
    fixed.place({});
    const auto found = prism_manifold(held, fixed, buffer);
    return std::vector<dContactGeom>(found->begin(), found->end());
  };
  const auto flat = points_at(0.0);
  ASSERT_EQ(flat.size(), 4U);
  for (const dContactGeom& point : flat) {
    EXPECT_NEAR(point.depth, 1e-4, 1e-9);
    EXPECT_NEAR(std::abs(point.pos[1]), 0.05, 1e-9);
    EXPECT_NEAR(std::abs(point.pos[2]), 0.05, 1e-9);
  }
  for (const double turned_rad : {-0.1, 0.1}) {
    const auto edge = points_at(turned_rad);
    ASSERT_EQ(edge.size(), 2U);
    for (const dContactGeom& point : edge) {
      EXPECT_NEAR(std::abs(point.pos[2]), 0.05, 1e-9);
      EXPECT_LT(turned_rad * point.pos[1], 0.0);  // the corner that the turn brings forward
    }
  }
}

}  // namespace
}  // namespace tenon::sim
