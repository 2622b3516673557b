// The shadow of a body of triangles, and where a plane cuts it.

#include "shared/drawing/silhouette.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "shared/drawing/prism.h"
#include "shared/geometry/extrusion.h"
#include "tests/support/example_parts.h"
#include "tests/support/meshes.h"

namespace tenon::drawing {
namespace {

constexpr View kAbove{0, 1, 2, ""};
constexpr View kSide{0, 2, 1, ""};

double area_m2(const Loops& loops) {
  double twice_m2 = 0.0;
  for (const std::vector<Point>& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point& a = loop[i];
      const Point& b = loop[(i + 1) % loop.size()];
      twice_m2 += a.x() * b.y() - a.y() * b.x();
    }
  }
  return std::abs(0.5 * twice_m2);
}

TEST(Silhouette, TheShadowOfATurnedBoxIsItsOutline) {
  const Solid box(tests::box_mesh({0.02, 0.04, 0.06}));
  const Loops straight = shadow_of(box, {}, kAbove);
  ASSERT_EQ(straight.size(), 1U);
  EXPECT_EQ(straight.front().size(), 4U);
  EXPECT_NEAR(area_m2(straight), 8e-4, 1e-12);
  const Pose turned = {{0.1, 0.0, 0.0}, rotation_of({0.0, std::numbers::pi / 6, 0.0})};
  EXPECT_NEAR(area_m2(shadow_of(box, turned, kAbove)),
              0.04 * (0.02 * std::cos(std::numbers::pi / 6) + 0.06 * 0.5), 1e-12);
}

TEST(Silhouette, AHollowOutlineKeepsItsHollow) {
  const Solid angle(
      extruded({{0, 0}, {0.03, 0}, {0.03, 0.01}, {0.01, 0.01}, {0.01, 0.03}, {0, 0.03}}, 0.02));
  EXPECT_NEAR(area_m2(shadow_of(angle, {}, kAbove)), 5e-4, 1e-12);
  EXPECT_NEAR(area_m2(shadow_of(angle, {}, kSide)), 6e-4, 1e-12);
}

TEST(Silhouette, ACutThroughASocketShowsItsHole) {
  const Solid socket(tests::example_parts().at("keyed_socket.stl"));
  const Solid peg(tests::example_parts().at("keyed_peg.stl"));
  const Pose pose{socket.centre_m(), Eigen::Quaterniond::Identity()};
  const Loops cut = section_of(socket, pose, kAbove, 0.015);
  ASSERT_EQ(cut.size(), 2U);
  const double hole_m2 = 60e-3 * 60e-3 - area_m2(cut);
  const double peg_m2 = area_m2(section_of(peg, {}, kAbove, 0.0));
  EXPECT_GT(peg_m2, 3.14e-4);
  // Half a millimetre of play around an outline of some 70 mm.
  EXPECT_NEAR(hole_m2 - peg_m2, 0.5e-3 * 70e-3, 3e-6);
  EXPECT_NEAR(area_m2(section_of(socket, pose, kAbove, -0.005)), 36e-4, 1e-9);
  EXPECT_TRUE(section_of(socket, pose, kAbove, 0.05).empty());
}

TEST(Silhouette, OfASolidThePrismHasAllPoints) {
  const auto solid = std::make_shared<const Solid>(tests::box_mesh({0.02, 0.04, 0.06}));
  const Shape shape{"box", Shape::Kind::kSolid, solid->size_m(), {{1, 0, 0}, {1, 0, 0, 0}}, solid};
  const Prism prism = prism_of(shape, {{0, 1, 0}, {1, 0, 0, 0}}, 24);
  ASSERT_EQ(prism.corners_m.size(), 8U);
  for (const Vector3& corner_m : prism.corners_m) {
    EXPECT_NEAR(std::abs(corner_m.x() - 1.0), 0.01, 1e-12);
    EXPECT_NEAR(std::abs(corner_m.y() - 1.0), 0.02, 1e-12);
  }
}

}  // namespace
}  // namespace tenon::drawing
