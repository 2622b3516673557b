// Meshes and extrusions in task files.

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "shared/config/load.h"
#include "shared/geometry/solid.h"
#include "tests/support/meshes.h"
#include "tests/support/places.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon {
namespace {

using testing::HasSubstr;
using tests::binary_stl;
using tests::box_mesh;

class LoadShapes : public testing::Test {
 protected:
  /// The toy, its held box replaced.
  [[nodiscard]] std::string put_task(const std::string& shape) const {
    std::ostringstream text;
    text << std::ifstream(tests::in_tree("planner/tasks/toy_1d.yaml")).rdbuf();
    std::string task = text.str();
    const std::string box = "box_m: [0.10, 0.10, 0.10]";
    task.replace(task.find(box), box.size(), shape);
    return folder.put("task.yaml", task);
  }
  [[nodiscard]] Task load(const std::string& shape) const { return load_task(put_task(shape)); }
  [[nodiscard]] std::string refused(const std::string& shape) const {
    return tests::refusal([&] { (void)load(shape); });
  }

  tests::ScratchFolder folder;
};

const TriangleMesh kBox = box_mesh({0.10, 0.10, 0.10}, {0.3, 0.0, 0.0});

TEST_F(LoadShapes, AMeshStandsWhereItsFilesOriginDoes) {
  folder.put("parts/box.STL", binary_stl(kBox, 1e-3));
  const Task task = load("mesh: {file: parts/box.STL, scale: 0.001}");
  const Shape& shape = task.held.front();
  EXPECT_EQ(shape.kind, Shape::Kind::kSolid);
  EXPECT_LT((shape.size_m - Vector3(0.1, 0.1, 0.1)).norm(), 1e-7);
  EXPECT_LT((shape.pose.position_m - Vector3(0.3, 0.0, 0.05)).norm(), 1e-7);
  ASSERT_NE(shape.solid, nullptr);
  EXPECT_EQ(shape.solid->mesh().triangles.size(), 12U);
}

TEST_F(LoadShapes, AnExtrusionIsDrawnOutAlongItsZ) {
  const Task task =
      load("extrusion: {profile_m: [[0, 0], [0.03, 0], [0.03, 0.02], [0, 0.04]], length_m: 0.1}");
  const Shape& shape = task.held.front();
  EXPECT_LT((shape.size_m - Vector3(0.03, 0.04, 0.1)).norm(), 1e-12);
  EXPECT_LT((shape.pose.position_m - Vector3(0.015, 0.02, 0.05)).norm(), 1e-12);
}

TEST_F(LoadShapes, TheHashCoversWhatTheFileHolds) {
  const std::string shape = "mesh: {file: box.stl, scale: 0.001}";
  folder.put("box.stl", binary_stl(kBox, 1e-3));
  const std::uint64_t first = load(shape).hash;
  EXPECT_EQ(load(shape).hash, first);
  folder.put("box.stl", binary_stl(box_mesh({0.10, 0.10, 0.11}), 1e-3));
  EXPECT_NE(load(shape).hash, first);
}

TEST_F(LoadShapes, BadFilesAreRefusedByName) {
  const std::string here = folder.path().string();
  EXPECT_EQ(refused("mesh: {file: none.stl, scale: 1}"),
            here + "/task.yaml:9: held[0].mesh: " + here +
                "/none.stl: cannot be read: No such file or directory");
  folder.put("part.step", "ISO-10303-21;");
  EXPECT_EQ(refused("mesh: {file: part.step, scale: 1}"),
            here + "/task.yaml:9: held[0].mesh: " + here +
                "/part.step: must be an STL or OBJ file: its name must end in .stl or .obj");
  TriangleMesh open = kBox;
  open.triangles.pop_back();
  folder.put("open.stl", binary_stl(open, 1e-3));
  EXPECT_THAT(refused("mesh: {file: open.stl, scale: 0.001}"),
              HasSubstr("/open.stl: 3 edges have a triangle on one side only, the first at ("));
  folder.put("box.stl", binary_stl(kBox, 1e-3));
  EXPECT_THAT(refused("mesh: {file: box.stl, scale: 1}"), HasSubstr("is scale right?"));
  EXPECT_THAT(refused("mesh: {file: box.stl}"), HasSubstr("scale"));
  EXPECT_THAT(refused("mesh: {file: box.stl, scale: 0}"), HasSubstr("must be in (0, 1000]"));
  EXPECT_THAT(refused("extrusion: {profile_m: [[0, 0], [1, 1], [1, 0], [0, 1]], length_m: 1}"),
              HasSubstr("profile_m: the sides after corners 0 and 2 cross or touch"));
  EXPECT_THAT(refused("extrusion: {profile_m: [[0, 0], [1, 1]], length_m: 1}"),
              HasSubstr("profile_m"));
}

}  // namespace
}  // namespace tenon
