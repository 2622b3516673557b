// Where a shape is pushed against: on its sides, away from their rims, and never into a hole.

#include "planner/search/touch_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "shared/geometry/extrusion.h"
#include "shared/geometry/solid.h"

namespace tenon::planner {
namespace {

using Profile = std::vector<Eigen::Vector2d>;

// A U whose middle is open: 60 mm wide, its right leg 24 mm, the others 10 mm.
const Profile kU = {{-0.030, -0.020}, {0.030, -0.020},  {0.030, 0.020},  {0.006, 0.020},
                    {0.006, -0.010},  {-0.020, -0.010}, {-0.020, 0.020}, {-0.030, 0.020}};

Shape drawn_out(const Profile& profile, double length_m, const Pose& pose) {
  Shape shape;
  shape.name = "u";
  shape.kind = Shape::Kind::kSolid;
  const auto solid = std::make_shared<const Solid>(tenon::extruded(profile, length_m));
  shape.solid = solid;
  shape.size_m = solid->size_m();
  shape.pose = pose;
  return shape;
}

double to_profile_m(const Profile& profile, const Eigen::Vector2d& p) {
  double least_m = 1.0;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Eigen::Vector2d a = profile[i];
    const Eigen::Vector2d way = profile[(i + 1) % profile.size()] - a;
    for (int k = 0; k <= 1000; ++k) least_m = std::min(least_m, (a + 1e-3 * k * way - p).norm());
  }
  return least_m;
}

TEST(TouchPlaces, ABoxIsPushedAgainstTheMiddleOfItsSide) {
  const Shape box{"box", Shape::Kind::kBox, {0.02, 0.04, 0.06}, {{0.1, 0.2, 0.3}, {1, 0, 0, 0}}};
  const auto places = touch_places(box, 2, -1, 0.01, Vector3::Zero());
  ASSERT_EQ(places.size(), 1U);
  EXPECT_TRUE(places[0].at_m.isApprox(Vector3(0.1, 0.2, 0.33)));
  EXPECT_NEAR(places[0].area_m2, 8e-4, 1e-12);
  EXPECT_NEAR(places[0].to_rim_m, 0.01, 1e-12);
  EXPECT_TRUE(places[0].side_m.min().isApprox(Vector3(0.09, 0.18, 0.33)));
  EXPECT_TRUE(places[0].side_m.max().isApprox(Vector3(0.11, 0.22, 0.33)));
}

TEST(TouchPlaces, TheTopOfAUIsTouchedWhereItIsBroadest) {
  const Shape u = drawn_out(kU, 0.03, {{0.5, 0.0, 0.1}, {1, 0, 0, 0}});
  const auto places = touch_places(u, 2, -1, 1.0, Vector3::Zero());
  ASSERT_EQ(places.size(), 1U);
  const Vector3 at_m = places[0].at_m;
  EXPECT_NEAR(at_m.z(), 0.115, 1e-9);
  EXPECT_NEAR(places[0].area_m2, 60e-3 * 10e-3 + 30e-3 * (24e-3 + 10e-3), 1e-9);
  EXPECT_GT(at_m.x() - 0.5, 0.006);
  const double rim_m = to_profile_m(kU, {at_m.x() - 0.5, at_m.y()});
  EXPECT_NEAR(rim_m, places[0].to_rim_m, 1e-4);
  EXPECT_GT(rim_m, 0.011);
  EXPECT_TRUE(places[0].side_m.min().isApprox(Vector3(0.47, -0.02, 0.115), 1e-9));
  EXPECT_TRUE(places[0].side_m.max().isApprox(Vector3(0.53, 0.02, 0.115), 1e-9));
}

TEST(TouchPlaces, WhereTheRimIsFarEnoughTheNearestPlaceIsTaken) {
  const Shape u = drawn_out(kU, 0.03, {});
  const auto places = touch_places(u, 2, -1, 0.004, {-0.025, 0.0, 0.0});
  ASSERT_EQ(places.size(), 1U);
  EXPECT_LT(places[0].at_m.x(), -0.02);
  EXPECT_GE(to_profile_m(kU, places[0].at_m.head<2>()), 0.004 - 1e-6);
}

TEST(TouchPlaces, SidesThatFaceTheSameWayAreOnePlaceEachTheLargestFirst) {
  const Shape u = drawn_out(kU, 0.03, {});
  const auto places = touch_places(u, 0, +1, 1.0, Vector3::Zero());
  ASSERT_EQ(places.size(), 2U);
  EXPECT_NEAR(places[0].at_m.x(), -0.030, 1e-9);
  EXPECT_NEAR(places[1].at_m.x(), 0.006, 1e-9);
  EXPECT_GT(places[0].area_m2, places[1].area_m2);
}

TEST(TouchPlaces, AnOuterSideIsFoundBehindAnyNumberOfLargerInnerOnes) {
  // A comb that lies on its back, 100 mm high: four slots between teeth, open above. Against +x
  // its inner sides are 90 mm high each, and its outer one is cut down to 20 mm by a step inwards.
  Profile comb = {{-0.060, 0.0}, {0.060, 0.0}, {0.060, 0.1}};
  for (int tooth = 4; tooth >= 0; --tooth) {
    const double left_m = -0.050 + 0.02 * tooth;
    comb.emplace_back(left_m, 0.1);
    comb.emplace_back(left_m, tooth == 0 ? 0.02 : 0.01);
    if (tooth > 0) {
      comb.emplace_back(left_m - 0.01, 0.01);
      comb.emplace_back(left_m - 0.01, 0.1);
    }
  }
  comb.emplace_back(-0.060, 0.02);
  const auto places = touch_places(drawn_out(comb, 0.03, {}), 0, +1, 1.0, Vector3::Zero());
  ASSERT_FALSE(places.empty());
  const auto outer = std::count_if(places.begin(), places.end(), [](const TouchPlace& place) {
    return place.at_m.x() < -0.0599;
  });
  EXPECT_EQ(outer, 1);
  EXPECT_TRUE(std::is_sorted(
      places.begin(), places.end(),
      [](const TouchPlace& a, const TouchPlace& b) { return a.area_m2 > b.area_m2; }));
}

TEST(TouchPlaces, ObliqueSidesFaceNoPush) {
  const Shape u = drawn_out(kU, 0.03, {Vector3::Zero(), rotation_of({0.0, 0.0, 0.3})});
  EXPECT_TRUE(touch_places(u, 0, +1, 1.0, Vector3::Zero()).empty());
  EXPECT_EQ(touch_places(u, 2, -1, 1.0, Vector3::Zero()).size(), 1U);
}

TEST(TouchPlaces, ARoundSideIsPushedAgainstWhereItIsForemost) {
  Profile round;
  for (int i = 0; i < 96; ++i) {
    const double at_rad = 2.0 * 3.14159265358979 * (i + 0.5) / 96.0;
    round.emplace_back(0.02 * std::cos(at_rad), 0.02 * std::sin(at_rad));
  }
  const Shape cylinder = drawn_out(round, 0.03, {{0.1, 0.0, 0.0}, {1, 0, 0, 0}});
  for (const int sign : {1, -1}) {
    const auto places = round_places(cylinder, 1, sign, {0.0, 0.0, 0.1});
    ASSERT_EQ(places.size(), 1U);
    EXPECT_NEAR(places[0].at_m.y(), -sign * 0.02, 0.02e-3);
    EXPECT_NEAR(places[0].at_m.x(), 0.1, 0.5e-3);
    // As high as what slopes by 25 degrees is away to either side.
    EXPECT_NEAR(places[0].to_rim_m, 0.02 * std::sin(25.0 * 3.14159 / 180.0), 1e-3);
    EXPECT_NEAR(places[0].at_m.z(), 0.015 - places[0].to_rim_m, 1.5e-3);
  }
  EXPECT_TRUE(round_places(cylinder, 2, -1, Vector3::Zero()).empty());
  EXPECT_TRUE(round_places(drawn_out(kU, 0.03, {}), 0, 1, Vector3::Zero()).empty());
}

}  // namespace
}  // namespace tenon::planner
