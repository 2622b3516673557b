// How far points are from a body of triangles.
#include "shared/geometry/solid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "shared/base/random.h"
#include "shared/geometry/extrusion.h"
#include "shared/geometry/nearest_cells.h"
#include "tests/support/example_parts.h"
#include "tests/support/meshes.h"

namespace tenon {
namespace {

using tests::box_mesh;

Vector3 drawn_in(Random& random, const Vector3& size_m) {
  return {(random.uniform() - 0.5) * size_m.x(), (random.uniform() - 0.5) * size_m.y(),
          (random.uniform() - 0.5) * size_m.z()};
}

double box_distance_m(const Vector3& point_m, const Vector3& size_m) {
  const Vector3 off_m = point_m.cwiseAbs() - 0.5 * size_m;
  return off_m.cwiseMax(0.0).norm() + std::min(0.0, off_m.maxCoeff());
}

/// By how many faces a ray crosses, and the closest of a fine net of points on every triangle.
double slow_distance_m(const TriangleMesh& mesh, const Vector3& point_m) {
  double least_m = 1e9;
  int crossed = 0;
  const Vector3 way = Vector3(0.3, 0.5, 0.81).normalized();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto c = mesh.corners_m(i);
    constexpr int kNet = 60;
    for (int u = 0; u <= kNet; ++u) {
      for (int v = 0; u + v <= kNet; ++v) {
        const Vector3 at_m = c[0] + u * (c[1] - c[0]) / kNet + v * (c[2] - c[0]) / kNet;
        least_m = std::min(least_m, (at_m - point_m).norm());
      }
    }
    Eigen::Matrix3d basis;
    basis << c[1] - c[0], c[2] - c[0], -way;
    const Vector3 solved = basis.inverse() * (point_m - c[0]);
    crossed +=
        solved.x() > 0.0 && solved.y() > 0.0 && solved.x() + solved.y() < 1.0 && solved.z() > 0.0;
  }
  return crossed % 2 == 1 ? -least_m : least_m;
}

TEST(Solid, ABoxIsAsFarAsItsFormulaSays) {
  const Vector3 size_m(0.02, 0.03, 0.05);
  const Solid solid(box_mesh(size_m, {0.3, 0.2, -0.1}));
  EXPECT_LT((solid.size_m() - size_m).norm(), 1e-12);
  EXPECT_LT((solid.centre_m() - Vector3(0.3, 0.2, -0.1)).norm(), 1e-12);
  EXPECT_EQ(solid.convex_edges().size(), 12U);
  Random random(1);
  for (int i = 0; i < 5000; ++i) {
    const Vector3 point_m = drawn_in(random, 2.0 * size_m);
    const Solid::Place place = solid.place(point_m, static_cast<std::uint32_t>(i % 12));
    EXPECT_NEAR(place.distance_m, box_distance_m(point_m, size_m), 1e-12);
    EXPECT_NEAR(place.outwards.norm(), 1.0, 1e-12);
    EXPECT_LT((point_m - place.distance_m * place.outwards - place.nearest_m).norm(), 1e-12);
  }
}

TEST(Solid, AHollowBodyIsAsFarAsASlowSearchFinds) {
  const TriangleMesh mesh =
      extruded({{0, 0}, {0.03, 0}, {0.03, 0.01}, {0.012, 0.008}, {0.01, 0.03}, {0, 0.03}}, 0.02);
  const Solid solid(mesh);
  Random random(2);
  int inside = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3 point_m = drawn_in(random, 1.4 * solid.size_m());
    const double slow_m = slow_distance_m(mesh, point_m + solid.centre_m());
    const double exact_m = solid.place(point_m).distance_m;
    inside += exact_m < 0.0;
    EXPECT_EQ(exact_m < 0.0, slow_m < 0.0) << point_m.transpose();
    // The net is half a millimetre wide at most.
    EXPECT_LE(std::abs(exact_m), std::abs(slow_m) + 1e-12);
    EXPECT_NEAR(exact_m, slow_m, 0.6e-3);
  }
  EXPECT_GT(inside, 20);
  EXPECT_LT(inside, 180);
  // The hollow corner is not sampled.
  EXPECT_EQ(solid.convex_edges().size(), 3U * 6U - 1U);
}

TEST(Solid, AGuessChangesNoBit) {
  const Solid solid(extruded(tests::round_profile(0.01, 40), 0.03));
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Vector3 point_m = drawn_in(random, 1.2 * solid.size_m());
    const Solid::Place plain = solid.place(point_m);
    const Solid::Place guessed = solid.place(
        point_m, static_cast<std::uint32_t>(random.uniform() * 0.999 *
                                            static_cast<double>(solid.mesh().triangles.size())));
    EXPECT_EQ(plain.distance_m, guessed.distance_m);
    EXPECT_EQ(plain.outwards, guessed.outwards);
    EXPECT_EQ(plain.triangle, guessed.triangle);
  }
}

TEST(Solid, WhatIsKeptOfAMovingPointChangesNoBit) {
  const Solid solid(extruded(tests::round_profile(0.01, 200), 0.03));
  Random random(4);
  NearestCells::Known known;
  Vector3 point_m = 0.5 * solid.size_m();
  int kept = 0;
  for (int i = 0; i < 20'000; ++i) {
    // Steps of a micrometre to ten millimetres, far from it and back to its middle.
    const double step_m = std::pow(10.0, -6.0 + 4.0 * random.uniform());
    point_m += drawn_in(random, Vector3::Constant(step_m)) - 1e-3 * point_m;
    const auto* before = known.near.data();
    const Solid::Place moved = solid.place(point_m, 0, known);  // no guess may make up for it
    kept += known.half_m > 0.0 && known.near.data() == before;
    const Solid::Place plain = solid.place(point_m);
    ASSERT_EQ(plain.distance_m, moved.distance_m) << i;
    ASSERT_EQ(plain.outwards, moved.outwards) << i;
    ASSERT_EQ(plain.triangle, moved.triangle) << i;
  }
  EXPECT_GT(kept, 2'000);
  EXPECT_LT(kept, 18'000);
}

TEST(Solid, SampledPlacesAreThoseOfTheSurfaceButForItsEdges) {
  const Vector3 size_m(0.04, 0.04, 0.04);
  const Solid solid(box_mesh(size_m));
  Random random(5);
  double flat_most_m = 0.0;
  double most_m = 0.0;
  constexpr double kSpacing_m = 0.04 / 256.0;
  for (int i = 0; i < 20'000; ++i) {
    const Vector3 point_m = drawn_in(random, 1.4 * size_m);
    const Solid::Place exact = solid.place(point_m);
    const Solid::Place sampled = solid.sampled_place(point_m);
    const double off_m = std::abs(sampled.distance_m - exact.distance_m);
    most_m = std::max(most_m, off_m);
    EXPECT_NEAR(sampled.outwards.norm(), 1.0, 1e-12);
    // Amid a face and not near another: two cells from where that changes.
    const Vector3 off_axes_m = point_m.cwiseAbs() - 0.5 * size_m;
    Eigen::Index face = 0;
    const double out_m = off_axes_m.maxCoeff(&face);
    const double next_m = std::max(off_axes_m[(face + 1) % 3], off_axes_m[(face + 2) % 3]);
    if (next_m < std::min(out_m, 0.0) - 2.0 * kSpacing_m) {
      flat_most_m = std::max(flat_most_m, off_m);
      EXPECT_GT(sampled.outwards.dot(exact.outwards), 1.0 - 1e-9);
    }
  }
  EXPECT_LT(flat_most_m, 1e-8);  // a float's, at these sizes
  EXPECT_LT(most_m, 0.6 * kSpacing_m);
  EXPECT_GT(most_m, 0.05 * kSpacing_m);
}

TEST(Solid, SampledPlacesAreTheSameWhateverWasAskedBefore) {
  // A node is computed by whoever needs it first, from any of the eight cells around it. Next to
  // the faces across the longest way, which go through nodes, a distance shows every rounding.
  const TriangleMesh mesh = tests::example_parts().at("keyed_socket.stl");
  const Solid forwards(mesh);
  const Solid backwards(mesh);
  const Solid bounded(mesh);
  Random random(6);
  std::vector<Vector3> points_m(20'000);
  for (Vector3& point_m : points_m) {
    point_m = Vector3(0.5, 0.2, 0.2).cwiseProduct(forwards.size_m()) +
              drawn_in(random, 0.05 * forwards.size_m());
  }
  std::vector<double> distances_m;
  for (const Vector3& point_m : points_m) {
    distances_m.push_back(forwards.sampled_place(point_m).distance_m);
    (void)bounded.distance_at_least_m(point_m);
  }
  for (std::size_t i = points_m.size(); i-- > 0;) {
    ASSERT_EQ(backwards.sampled_place(points_m[i]).distance_m, distances_m[i]) << i;
    ASSERT_EQ(bounded.sampled_place(points_m[i]).distance_m, distances_m[i]) << i;
  }
}

TEST(Solid, NoPlaceIsNearerThanItsLowerBound) {
  const Solid solid(tests::example_parts().at("keyed_socket.stl"));
  // The nearest node is no farther than half a cell's diagonal, and its own distance no more off.
  const double slack_m = std::sqrt(3.0) / 256.0 * solid.size_m().maxCoeff() + 1e-6;
  Random random(7);
  for (int i = 0; i < 3000; ++i) {
    Vector3 point_m;
    for (int axis = 0; axis < 3; ++axis) {
      point_m[axis] = 1.6 * (random.uniform() - 0.5) * solid.size_m()[axis];
    }
    const double exact_m = solid.place(point_m).distance_m;
    const double at_least_m = solid.distance_at_least_m(point_m);
    EXPECT_LE(at_least_m, exact_m + 1e-12);
    EXPECT_GE(at_least_m, exact_m - slack_m);
  }
}

TEST(Solid, BeyondItsLatticeAPlaceIsExact) {
  const Solid solid(box_mesh({0.01, 0.02, 0.03}));
  const Vector3 far_m(0.5, -0.2, 0.1);
  EXPECT_EQ(solid.sampled_place(far_m).distance_m, solid.place(far_m).distance_m);
  EXPECT_EQ(solid.sampled_place(far_m).nearest_m, solid.place(far_m).nearest_m);
}

TEST(NearestCells, WhatACellRemembersIsWhatTheTreeFinds) {
  // Each facet of the round is as near to its axis as any other: more than a cell remembers.
  const Solid solid(extruded(tests::round_profile(0.01, 100), 0.03));
  const TriangleTree tree(solid.mesh());
  const NearestCells cells(solid.size_m());
  Random random(4);
  for (int i = 0; i < 20000; ++i) {
    // Some are beyond all cells, some are asked for twice, some lie on the faces between two.
    Vector3 point_m = drawn_in(random, (i % 3 == 0 ? 2.5 : 1.1) * solid.size_m());
    if (i % 5 == 0) point_m.x() = std::round(point_m.x() / 2e-3) * 2e-3;
    for (const std::uint32_t guess : {0U, static_cast<std::uint32_t>(i % 100)}) {
      NearestCells::Known known;
      const NearestOnTriangle found = cells.nearest(tree, point_m, guess, known);
      const NearestOnTriangle expected = tree.nearest(point_m);
      ASSERT_EQ(found.at_m, expected.at_m) << point_m.transpose();
      ASSERT_EQ(found.square_m2, expected.square_m2);
      ASSERT_EQ(found.triangle, expected.triangle);
      ASSERT_EQ(found.part, expected.part);
    }
  }
}

}  // namespace
}  // namespace tenon
