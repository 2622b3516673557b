// What STL and OBJ files say, and what is refused in them.
#include "shared/geometry/mesh_file.h"

#include <gmock/gmock.h>

#include "shared/base/error.h"
#include "shared/geometry/mesh_check.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"

namespace tenon {
namespace {

using testing::HasSubstr;
using tests::ascii_stl;
using tests::binary_stl;
using tests::box_mesh;
using tests::obj;

const TriangleMesh kBox = box_mesh({0.01, 0.02, 0.03}, {0.1, 0.0, 0.0});

void expect_box(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.triangles.size(), 12U);
  ASSERT_EQ(mesh.points_m.size(), 8U);
  EXPECT_NO_THROW(check_mesh(mesh));
  for (std::size_t i = 0; i < 12; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_LT((mesh.corners_m(i)[j] - kBox.corners_m(i)[j]).norm(), 1e-8);
    }
  }
}

TEST(MeshFile, EachFormatGivesTheSameBody) {
  expect_box(read_stl(binary_stl(kBox, 1e-3), 1e-3));
  expect_box(read_stl(ascii_stl(kBox, 1e-3), 1e-3));
  expect_box(read_obj(obj(kBox, 1e-3), 1e-3));
}

TEST(MeshFile, ABinaryFileMayBeginLikeText) {
  std::string bytes = binary_stl(kBox, 1.0);
  bytes.replace(0, 5, "solid");
  expect_box(read_stl(bytes, 1.0));
}

TEST(MeshFile, ObjCornersCountFromBothEnds) {
  const TriangleMesh mesh = read_obj(
      "mtllib x.mtl\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\n"
      "usemtl red\ns off\nf 1//1 2//1 3//1 -1/1/1\n",
      1.0);
  ASSERT_EQ(mesh.triangles.size(), 2U);
  EXPECT_EQ(mesh.corners_m(1)[2], Vector3(0, 1, 0));
}

TEST(MeshFile, StlIsRefusedWithTheReason) {
  const std::string bytes = binary_stl(kBox, 1.0);
  const auto refused = [](const std::string& file) {
    return tests::refusal([&] { (void)read_stl(file, 1.0); });
  };
  EXPECT_THAT(refused(""), HasSubstr("has 0 bytes, an STL file at least 84"));
  EXPECT_THAT(refused(bytes.substr(0, 300)),
              HasSubstr("has 300 bytes, its 12 triangles need 684: it is truncated"));
  EXPECT_THAT(refused(bytes + "x"), HasSubstr("need 684: it is damaged"));
  std::string many = bytes;
  many.replace(80, 4, std::string("\x40\x4B\x4C\x00", 4));  // 5,000,000
  EXPECT_THAT(refused(many), HasSubstr("has 5000000 triangles, must be at most 200000: export"));
  std::string nan = bytes;
  nan.replace(84 + 12, 4, std::string("\x00\x00\xC0\x7F", 4));
  EXPECT_THAT(refused(nan), HasSubstr("triangle 0: a coordinate is not a finite number"));
  const std::string text = ascii_stl(kBox, 1.0);
  EXPECT_THAT(refused(text.substr(0, text.find("endsolid"))),
              HasSubstr("line 85: the file ends before endsolid: it is truncated"));
  EXPECT_THAT(refused(text.substr(0, 200)), HasSubstr("truncated, export it again"));
  EXPECT_THAT(refused("solid\nfacet\nouter loop\nvertex 0 0 nan\n"),
              HasSubstr("line 4: 'nan' must be a finite number"));
  EXPECT_THAT(refused("solid\nfacet\nouter loop\nvertex 0 0\n"),
              HasSubstr("line 4: a vertex must have three numbers"));
  EXPECT_THAT(refused("solid\nfacet\nouter loop\nendloop\n"),
              HasSubstr("line 4: 'endloop' must be vertex"));
  EXPECT_THAT(refused("solid\ntetrahedron\n"),
              HasSubstr("line 2: 'tetrahedron' must be solid, facet or endsolid"));
}

TEST(MeshFile, ObjIsRefusedWithTheReason) {
  const auto refused = [](const std::string& file) {
    return tests::refusal([&] { (void)read_obj(file, 1.0); });
  };
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  EXPECT_THAT(refused("v 0 0\n"), HasSubstr("line 1: a vertex must have three numbers"));
  EXPECT_THAT(refused("v 0 0 inf\n"), HasSubstr("line 1: 'inf' must be a finite number"));
  EXPECT_THAT(refused(square + "f 1 2 5\n"),
              HasSubstr("line 5: corner '5' of a face must name one of the 4 vertices before it"));
  EXPECT_THAT(refused(square + "f 0 1 2\n"), HasSubstr("corner '0'"));
  EXPECT_THAT(refused(square + "f a b c\n"), HasSubstr("corner 'a'"));
  EXPECT_THAT(refused(square + "f 1 2\n"), HasSubstr("a face must have three corners or more"));
  EXPECT_THAT(refused(square + "v 0.5 0.1 0\nf 1 5 2 3 4\n"),
              HasSubstr("a face of 5 corners is not flat and convex: export triangles"));
  EXPECT_THAT(refused(square + "v 0 0 1\nf 1 2 3 5\n"), HasSubstr("not flat and convex"));
  EXPECT_THAT(refused("curv 0 1 2\n"), HasSubstr("line 1: 'curv' is no keyword"));
}

}  // namespace
}  // namespace tenon
