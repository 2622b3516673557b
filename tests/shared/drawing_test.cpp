// What reports are drawn with: from where, what of a shape, and how it stands on a page.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "shared/base/random.h"
#include "shared/drawing/html.h"
#include "shared/drawing/prism.h"
#include "shared/drawing/scene_json.h"
#include "shared/drawing/step_words.h"
#include "shared/drawing/view.h"

namespace tenon::drawing {
namespace {

std::vector<std::pair<int, int>> axes_of(CoordinateMask coordinates) {
  std::vector<std::pair<int, int>> axes;
  for (const View& view : views_of(coordinates)) axes.emplace_back(view.right, view.up);
  return axes;
}

TEST(DrawingView, ShowsThePlanesThatTheTaskMovesIn) {
  using Axes = std::vector<std::pair<int, int>>;
  EXPECT_EQ(axes_of(0b000011), (Axes{{0, 1}}));
  EXPECT_EQ(axes_of(0b000001), (Axes{{0, 1}}));
  EXPECT_EQ(axes_of(0b000101), (Axes{{0, 2}}));
  EXPECT_EQ(axes_of(0b000100), (Axes{{0, 2}}));
  EXPECT_EQ(axes_of(0b010101), (Axes{{0, 2}})) << "a rotation about y shows from the side";
  EXPECT_EQ(axes_of(0b000110), (Axes{{1, 2}}));
  EXPECT_EQ(axes_of(0b000111), (Axes{{0, 1}, {0, 2}}));
}

TEST(DrawingView, LooksAlongTheAxisThatItDoesNotShow) {
  for (CoordinateMask mask = 1; mask < 64; ++mask) {
    for (const View& view : views_of(mask)) EXPECT_EQ(view.right + view.up + view.along, 3);
  }
  const View side = views_of(0b101).front();
  EXPECT_EQ(side.m({0.1, 0.2, 0.3}), Point(0.1, 0.3));
  EXPECT_EQ(side.mm({0.1, 0.2, 0.3}), Point(1e3 * 0.1, 1e3 * 0.3));
}

Shape box(const Vector3& size_m) {
  Shape shape;
  shape.size_m = size_m;
  return shape;
}

TEST(DrawingPrism, ABoxHasItsEightCorners) {
  const Prism prism = prism_of(box({0.2, 0.4, 0.6}), Pose{}, 24);
  ASSERT_EQ(prism.sides(), 4U);
  for (std::size_t i = 0; i < 8; ++i) {
    const Vector3 corner = prism.corners_m[i].cwiseAbs();
    EXPECT_LT((corner - Vector3(0.1, 0.2, 0.3)).norm(), 1e-12) << i;
    EXPECT_EQ(prism.corners_m[i].z() < 0.0, i < 4) << "those below come first";
  }
}

TEST(DrawingPrism, ACylinderHasAsManySidesAsAskedForAndStandsInItsFrame) {
  Shape rod = box({0.2, 0.2, 1.0});
  rod.kind = Shape::Kind::kCylinder;
  rod.pose.position_m = {0.0, 0.0, 0.5};
  Pose frame;
  frame.position_m = {1.0, 0.0, 0.0};
  frame.orientation = rotation_of({0.0, 0.5 * M_PI, 0.0});  // its z along x
  const Prism prism = prism_of(rod, frame, 32);
  ASSERT_EQ(prism.sides(), 32U);
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_NEAR(prism.corners_m[i].x(), i < 32 ? 1.0 : 2.0, 1e-12);
    EXPECT_NEAR(prism.corners_m[i].tail<2>().norm(), 0.1, 1e-12);
  }
}

/// Whether p is to the left of the way from a to b, or on it.
bool left_of(const Point& a, const Point& b, const Point& p) {
  const Point along = b - a;
  return along.x() * (p - a).y() - along.y() * (p - a).x() >= -1e-12;
}

TEST(DrawingHull, HoldsEveryPointAndTurnsLeftAtEveryCorner) {
  Random random(5);
  for (int round = 0; round < 200; ++round) {
    std::vector<Point> points;
    for (int i = 0; i < 3 + round % 20; ++i) points.emplace_back(random.uniform(), random.normal());
    const std::vector<Point> hull = hull_of(points);
    ASSERT_GE(hull.size(), 3U);
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Point& next = hull[(i + 1) % hull.size()];
      EXPECT_NE(std::find(points.begin(), points.end(), hull[i]), points.end());
      for (const Point& p : points) EXPECT_TRUE(left_of(hull[i], next, p));
    }
  }
}

TEST(DrawingHull, LeavesOutWhatLiesOnAnEdgeAndWhatStandsTwice) {
  const std::vector<Point> square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0}, {1, 1}, {0.5, 0.5}};
  EXPECT_EQ(hull_of(square), (std::vector<Point>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
  EXPECT_EQ(hull_of({{1, 2}}).size(), 1U);
  EXPECT_TRUE(hull_of({}).empty());
}

TEST(DrawingHtml, TextCannotBecomeMarkup) {
  EXPECT_EQ(escaped("a < b > c & d's"), "a &lt; b &gt; c &amp; d&#39;s");
  EXPECT_EQ(escaped("\u03c3 = 3 %"), "\u03c3 = 3 %");
  EXPECT_EQ(escaped("&lt;"), "&amp;lt;") << "once more, not twice the same";
}

TEST(DrawingHtml, AFigureHoldsItsPictureThenItsCaption) {
  EXPECT_EQ(figure("<svg/>", "what"), "<figure><svg/><figcaption>what</figcaption></figure>\n");
}

TEST(DrawingStepWords, OnlyAxesThatWouldShowAreNamed) {
  Step step;
  step.displacement << 0.1004, -4e-4, -0.02, 0.0, 8e-4, -0.0349066;
  EXPECT_EQ(displacement_text(step), "x +100 mm, z -20 mm, rz -2.0\u00b0");
  EXPECT_EQ(displacement_text(Step{}), "");
}

TEST(DrawingScene, ViewsAreThoseOfTheCoordinates) {
  EXPECT_EQ(views_json(0b000011), R"([{"right":0,"up":1,"along":2,"title":"Seen from above"}])");
  EXPECT_EQ(views_json(0b000101),
            R"([{"right":0,"up":2,"along":1,"title":"Seen from the side, along y"}])");
}

TEST(DrawingHtml, PointsAreRoundedToTheDecimalsAskedFor) {
  const std::vector<Point> points = {{1.25, -3.0}, {0.126, 10.0}};
  EXPECT_EQ(points_text(points, 2), "1.25,-3.00 0.13,10.00 ");
  EXPECT_EQ(polygon(points, 0, "fill='red'"), "<polygon points='1,-3 0,10 ' fill='red'/>\n");
}

}  // namespace
}  // namespace tenon::drawing
