// What makes triangles a body.
#include "shared/geometry/mesh_check.h"

#include <gmock/gmock.h>

#include "shared/geometry/extrusion.h"
#include "shared/geometry/mesh_needles.h"
#include "shared/geometry/solid.h"
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
  EXPECT_THAT(refused(box_mesh({1e-2, 1e-2, 1e-6})),
              HasSubstr("measures 1e-06 m along z, must be at least 1e-05 m: is scale too small?"));
  TriangleMesh needle = kCheckedBox;
  needle.triangles.push_back({0, 0, 1});
  EXPECT_THAT(refused(needle), HasSubstr("1 of its triangles, number 12 first, at (-5.0000, "
                                         "-10.0000, -15.0000) mm, are 0.0e+00 m high or less, "
                                         "must be at least 1e-11 m"));
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

/// Volume by the divergence theorem.
double volume_m3(const TriangleMesh& mesh) {
  double six_m3 = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto c = mesh.corners_m(i);
    six_m3 += c[0].dot(c[1].cross(c[2]));
  }
  return six_m3 / 6.0;
}

TEST(MeshNeedles, ACornerOnAnEdgeBecomesOneOfTheTriangleBeyond) {
  // Of one triangle a corner more, on its first edge: the surface is closed by a needle.
  for (const double at : {0.5, 1e-3}) {
    TriangleMesh mesh = kCheckedBox;
    const Triangle cut = mesh.triangles[4];
    const auto more = static_cast<std::uint32_t>(mesh.points_m.size());
    mesh.points_m.push_back((1.0 - at) * mesh.points_m[cut[0]] + at * mesh.points_m[cut[1]]);
    mesh.triangles[4] = {cut[0], more, cut[2]};
    mesh.triangles.push_back({more, cut[1], cut[2]});
    mesh.triangles.push_back({cut[0], cut[1], more});
    EXPECT_THAT(refused(mesh), HasSubstr("1 of its triangles, number 13 first"));
    const TriangleMesh mended = without_needles(mesh);
    EXPECT_NO_THROW(check_mesh(mended));
    EXPECT_EQ(mended.triangles.size(), mesh.triangles.size());
    EXPECT_NEAR(volume_m3(mended), 6e-6, 1e-15);
  }
}

TEST(MeshNeedles, ManyCornersOnAnEdgeAndOnesThatRoundingFoldedBack) {
  // Along one edge eight corners that the triangle beyond does not have, each off by a rounding.
  for (const double off_m : {0.0, 0.4e-6, -0.4e-6}) {
    TriangleMesh mesh = kCheckedBox;
    const Triangle cut = mesh.triangles[4];
    const Vector3 way_m = mesh.points_m[cut[1]] - mesh.points_m[cut[0]];
    const Vector3 inwards =
        (mesh.points_m[cut[2]] - mesh.points_m[cut[0]]).cross(way_m).cross(way_m).normalized();
    std::vector<std::uint32_t> along = {cut[0]};
    constexpr int kMore = 8;
    for (int i = 1; i <= kMore; ++i) {
      along.push_back(static_cast<std::uint32_t>(mesh.points_m.size()));
      mesh.points_m.push_back(mesh.points_m[cut[0]] + way_m * (i / (kMore + 1.0)) +
                              off_m * inwards);
    }
    along.push_back(cut[1]);
    mesh.triangles.erase(mesh.triangles.begin() + 4);
    for (std::size_t i = 0; i + 1 < along.size(); ++i) {
      mesh.triangles.push_back({along[i], along[i + 1], cut[2]});
      if (i > 0) mesh.triangles.push_back({cut[0], along[i + 1], along[i]});
    }
    const TriangleMesh mended = without_needles(mesh);
    EXPECT_NO_THROW(check_mesh(mended)) << off_m;
    EXPECT_NEAR(volume_m3(mended), 6e-6, 1e-9);
    // Whatever lies nearest, a point inside is inside, and one outside is not.
    const Solid solid(mended);
    for (int i = 0; i < 2000; ++i) {
      const double at = (i + 0.5) / 2000.0;
      const Vector3 edge_m = (1.0 - at) * mesh.points_m[cut[0]] + at * mesh.points_m[cut[1]];
      for (const double out_m : {1e-3, -1e-3}) {
        const Vector3 point_m = edge_m - solid.centre_m() + out_m * edge_m.normalized();
        EXPECT_EQ(solid.place(point_m).distance_m > 0.0, out_m > 0.0) << off_m << ' ' << at;
      }
    }
  }
}

TEST(MeshNeedles, CornersThatAreNearlyTheSameBecomeOne) {
  // A corner twice, a picometre apart, and two needles between.
  TriangleMesh mesh = kCheckedBox;
  const Triangle cut = mesh.triangles[0];
  const auto twin = static_cast<std::uint32_t>(mesh.points_m.size());
  mesh.points_m.push_back(mesh.points_m[cut[0]] + Vector3(1e-12, 0.0, 0.0));
  mesh.triangles[0] = {twin, cut[1], cut[2]};
  mesh.triangles.push_back({cut[0], cut[1], twin});
  mesh.triangles.push_back({cut[0], twin, cut[2]});
  EXPECT_THAT(refused(mesh), HasSubstr("2 of its triangles"));
  const TriangleMesh mended = without_needles(mesh);
  EXPECT_NO_THROW(check_mesh(mended));
  EXPECT_EQ(mended.triangles.size(), kCheckedBox.triangles.size());
  EXPECT_NEAR(volume_m3(mended), 6e-6, 1e-15);
}

TEST(MeshNeedles, WhatIsSoundOrWhollyFlatStaysAsItIs) {
  EXPECT_EQ(without_needles(kCheckedBox).triangles, kCheckedBox.triangles);
  const TriangleMesh tiny = box_mesh({1e-12, 1e-12, 1e-12});
  EXPECT_EQ(without_needles(tiny).triangles, tiny.triangles);
}

}  // namespace
}  // namespace tenon
