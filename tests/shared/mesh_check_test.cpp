// What makes triangles a body.
#include "shared/geometry/mesh_check.h"

#include <gmock/gmock.h>

#include "shared/geometry/extrusion.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"

namespace tenon {
namespace {

using testing::HasSubstr;
using tests::box_mesh;
using tests::together;
using tests::turned_about;

std::string refused(const TriangleMesh& mesh) {
  return tests::refusal([&] { check_mesh(mesh); });
}

std::string refused(const tests::Profile& profile) {
  return tests::refusal([&] { (void)extruded(profile, 0.01); });
}

const TriangleMesh kCheckedBox = box_mesh({0.01, 0.02, 0.03});

TEST(MeshCheck, BodiesPass) {
  EXPECT_NO_THROW(check_mesh(kCheckedBox));
  EXPECT_NO_THROW(check_mesh(extruded(tests::round_profile(0.01, 40), 0.03)));
  EXPECT_NO_THROW(check_mesh(extruded({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 0.5)));
  // Clockwise, too.
  EXPECT_NO_THROW(check_mesh(extruded({{0, 3}, {1, 3}, {1, 1}, {3, 1}, {3, 0}, {0, 0}}, 0.5)));
  // A hollow, and two bodies beside each other.
  EXPECT_NO_THROW(check_mesh(together(kCheckedBox, turned_about(box_mesh({0.005, 0.005, 0.005})))));
  EXPECT_NO_THROW(check_mesh(together(kCheckedBox, box_mesh({0.01, 0.01, 0.01}, {0.05, 0, 0}))));
}

TEST(MeshCheck, WhatIsNoBodyIsRefused) {
  EXPECT_THAT(refused(TriangleMesh{}), HasSubstr("has no triangle"));

  TriangleMesh open = kCheckedBox;
  open.triangles.pop_back();
  EXPECT_THAT(refused(open), HasSubstr("3 edges have a triangle on one side only, the first at "));
  EXPECT_THAT(refused(open), HasSubstr("the surface is open; close its holes"));

  EXPECT_THAT(refused(turned_about(kCheckedBox)),
              HasSubstr("is inside out, its volume -6000 mm3 at ("));

  TriangleMesh partly = kCheckedBox;
  std::swap(partly.triangles[3][0], partly.triangles[3][1]);
  EXPECT_THAT(refused(partly), HasSubstr("edges lie between triangles that face opposite ways"));

  TriangleMesh doubled = kCheckedBox;
  doubled.triangles.push_back(doubled.triangles.front());
  EXPECT_THAT(refused(doubled), HasSubstr("edges of triangles are shared by more than two"));

  TriangleMesh infinite = kCheckedBox;
  infinite.points_m[3].y() = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refused(infinite), HasSubstr("a coordinate is not a finite number"));

  EXPECT_THAT(refused(box_mesh({10, 20, 300})),
              HasSubstr("reaches 150 m from its origin, must be at most 100 m: is scale right?"));
  EXPECT_THAT(
      refused(box_mesh({1e-2, 1e-2, 1e-10})),
      HasSubstr("8 of its triangles, number 4 first, at (-5.0000, -5.0000, -0.0000) mm, are "
                "1.0e-10 m high or less, must be at least 1e-09 m"));
}

TEST(MeshCheck, WhatMeetsItselfIsRefused) {
  EXPECT_THAT(refused(together(kCheckedBox, box_mesh({0.02, 0.01, 0.01}))),
              HasSubstr("of its triangles go through others, the first at ("));
  EXPECT_THAT(refused(together(kCheckedBox, box_mesh({0.001, 0.001, 0.001}))),
              HasSubstr("a shell of 1 mm3 at (-0.5000, -0.5000, -0.5000) mm lies inside another"));
  EXPECT_THAT(
      refused(together(kCheckedBox, turned_about(box_mesh({0.01, 0.01, 0.01}, {0.05, 0, 0})))),
      HasSubstr("is inside out, its volume -1000 mm3"));
  // Two boxes at one corner.
  EXPECT_THAT(refused(welded(together(box_mesh({0.01, 0.01, 0.01}),
                                      box_mesh({0.01, 0.01, 0.01}, {0.01, 0.01, 0.01})))),
              HasSubstr("meet in the one point at (5.0000, 5.0000, 5.0000) mm"));
  // Two boxes at one edge.
  EXPECT_THAT(refused(welded(together(box_mesh({0.01, 0.01, 0.01}),
                                      box_mesh({0.01, 0.01, 0.01}, {0.01, 0.01, 0.0})))),
              HasSubstr("edges of triangles are shared by more than two"));
}

TEST(MeshCheck, OutlinesThatEncloseNothingAreRefused) {
  EXPECT_THAT(refused({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}),
              HasSubstr("corner 4 is 0.0e+00 m from the next"));
  EXPECT_THAT(refused({{0, 0}, {1, 0}, {2, 0}, {2, 1}}),
              HasSubstr("corner 1 lies on a line with its neighbours"));
  EXPECT_THAT(refused({{0, 0}, {1, 1}, {1, 0}, {0, 1}}),
              HasSubstr("the sides after corners 0 and 2 cross or touch"));
  EXPECT_THAT(refused({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}), HasSubstr("cross or touch"));
}

}  // namespace
}  // namespace tenon
