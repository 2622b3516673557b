// What the report draws: what a plane cuts, and what the picture holds.

#include "planner/report/report_canvas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numbers>

#include "shared/geometry/extrusion.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

Shape box(const Vector3& size_m, const Vector3& at_m) {
  Shape shape;
  shape.name = "box";
  shape.size_m = size_m;
  shape.pose.position_m = at_m;
  return shape;
}

Canvas from_the_side() {
  Task task = room_task();
  task.environment = {box({1.0, 1.0, 1.0}, Vector3::Zero())};
  return {drawing::views_of(0b101).front(), task, {Vector3::Zero()}};
}

std::size_t corners(const std::string& polygon) {
  return static_cast<std::size_t>(std::count(polygon.begin(), polygon.end(), ','));
}

TEST(ReportCanvas, DrawsASolidWithItsHollows) {
  const auto solid = std::make_shared<const Solid>(
      extruded({{0, 0}, {0.3, 0}, {0.3, 0.1}, {0.1, 0.1}, {0.1, 0.3}, {0, 0.3}}, 0.2));
  Shape shape{"angle", Shape::Kind::kSolid, solid->size_m(), {}, solid};
  shape.pose.orientation = rotation_of({0.5 * std::numbers::pi, 0.0, 0.0});
  const Canvas canvas = from_the_side();
  const std::string shadow = canvas.shadow(shape, Pose{}, "fill='red'");
  EXPECT_TRUE(shadow.starts_with("<path d='M")) << shadow;
  EXPECT_EQ(corners(shadow), 6U) << shadow;
  EXPECT_NE(shadow.find("fill-rule='nonzero'"), std::string::npos);
  EXPECT_NE(shadow.find("fill='red'"), std::string::npos);
  EXPECT_NE(canvas.section(shape, 0.05, "").find("fill-rule='evenodd'"), std::string::npos);
  EXPECT_EQ(canvas.section(shape, 0.15, ""), "");
}

TEST(ReportCanvas, CutsAShapeWhereThePlanePassesThroughItAndNowhereElse) {
  const Canvas canvas = from_the_side();
  const Shape shape = box({0.2, 0.1, 0.4}, {0.1, 0.3, 0.0});
  EXPECT_EQ(canvas.section(shape, 0.0, ""), "");
  EXPECT_EQ(canvas.section(shape, 0.36, ""), "");
  const std::string cut = canvas.section(shape, 0.3, "fill='red'");
  EXPECT_EQ(corners(cut), 4U);
  // x from 0 to 200 mm, z from -200 to 200 mm; the page's y points down.
  for (const char* corner : {"0.00,200.00", "0.00,-200.00", "200.00,200.00", "200.00,-200.00"}) {
    EXPECT_NE(cut.find(corner), std::string::npos) << cut;
  }
  EXPECT_NE(cut.find("fill='red'"), std::string::npos);
}

TEST(ReportCanvas, CutsACylinderOnItsSideAcrossItsAxis) {
  Shape rod;
  rod.kind = Shape::Kind::kCylinder;
  rod.size_m = {0.1, 0.1, 0.4};
  rod.pose.orientation = rotation_of({0.5 * M_PI, 0.0, 0.0});  // along y
  EXPECT_EQ(corners(from_the_side().section(rod, 0.0, "")), 24U);
  EXPECT_EQ(from_the_side().section(rod, 0.21, ""), "");
}

TEST(ReportCanvas, AShadowIsTheOutlineOfAllOfIt) {
  const Canvas canvas = from_the_side();
  EXPECT_EQ(corners(canvas.shadow(box({0.2, 0.1, 0.4}, {0.1, 0.3, 0.0}), Pose{}, "")), 4U);
  Pose turned;
  turned.orientation = rotation_of({0.3, 0.4, 0.5});
  EXPECT_EQ(corners(canvas.shadow(box({0.2, 0.1, 0.4}, Vector3::Zero()), turned, "")), 6U);
}

TEST(ReportCanvas, APictureHoldsEverythingWithARim) {
  // 1 m wide and 2 % on each side: from -520 to 520 mm.
  EXPECT_NE(from_the_side().open("side").find("viewBox='-520.00 -520.00 1040.00 1040.00'"),
            std::string::npos)
      << from_the_side().open("side");
}

TEST(ReportCanvas, APictureHoldsThePartWhereverItGoes) {
  Task task = room_task();
  task.held = {box({0.2, 0.2, 0.2}, Vector3::Zero())};
  const Canvas canvas(drawing::views_of(0b101).front(), task, {Vector3::Zero(), {-0.73, 0.0, 0.0}});
  // From -830 mm to the goal at 170 and 100 more: 1100 mm, and 22 on each side.
  EXPECT_NE(canvas.open("side").find("viewBox='-852.00 "), std::string::npos)
      << canvas.open("side");
}

}  // namespace
}  // namespace tenon::planner
