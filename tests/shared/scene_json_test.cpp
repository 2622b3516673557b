// Shapes as triangles, and as the pages read them.

#include "shared/drawing/scene_json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "shared/drawing/surface.h"
#include "shared/geometry/solid.h"

namespace tenon::drawing {
namespace {

/// Of a closed surface: the volume inside (divergence theorem).
double volume_m3(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = mesh.corners_m(i);
    volume += a.dot(b.cross(c)) / 6.0;
  }
  return volume;
}

/// A torus of so many triangles around z.
TriangleMesh torus(std::uint32_t around, std::uint32_t across) {
  constexpr double kLarge_m = 0.05;
  constexpr double kSmall_m = 0.02;
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = 2.0 * M_PI * i / around;
      const double v = 2.0 * M_PI * j / across;
      const double reach = kLarge_m + kSmall_m * std::cos(v);
      mesh.points_m.emplace_back(reach * std::cos(u), reach * std::sin(u), kSmall_m * std::sin(v));
      const std::uint32_t k = (i + 1) % around;
      const std::uint32_t l = (j + 1) % across;
      mesh.triangles.push_back({i * across + j, k * across + j, k * across + l});
      mesh.triangles.push_back({i * across + j, k * across + l, i * across + l});
    }
  }
  return mesh;
}

TEST(Surface, OfABoxAndACylinderFacesOutwards) {
  Shape shape;
  shape.size_m = {0.1, 0.2, 0.3};
  shape.pose.position_m = {1.0, -2.0, 3.0};
  EXPECT_NEAR(volume_m3(surface_of(shape, 40, 1000)), 0.006, 1e-9);
  shape.kind = Shape::Kind::kCylinder;
  shape.size_m = {0.1, 0.1, 0.3};
  const double circle_m3 = M_PI * 0.05 * 0.05 * 0.3;
  const double cylinder_m3 = volume_m3(surface_of(shape, 40, 1000));
  EXPECT_LT(cylinder_m3, circle_m3);
  EXPECT_NEAR(cylinder_m3, circle_m3, 0.005 * circle_m3);
}

TEST(Surface, AFineMeshBecomesCoarseAndKeepsItsVolume) {
  const TriangleMesh fine = torus(120, 60);
  ASSERT_EQ(fine.triangles.size(), 14'400U);
  EXPECT_EQ(decimated(fine, 14'400).triangles.size(), 14'400U);
  const TriangleMesh coarse = decimated(fine, 2'000);
  EXPECT_LE(coarse.triangles.size(), 2'000U);
  EXPECT_GE(coarse.triangles.size(), 800U);
  EXPECT_NEAR(volume_m3(coarse), volume_m3(fine), 0.1 * volume_m3(fine));
}

TEST(SceneJson, HoldsEveryShapeByTheNameOfTheWhole) {
  Task task;
  Shape shape;
  shape.size_m = {0.1, 0.2, 0.3};
  shape.name = "a \"peg\"";
  task.held = {shape};
  shape.name = "hole[11]";
  task.environment = {shape};
  const auto json = nlohmann::json::parse(scene_json(task));
  EXPECT_EQ(json["held"][0]["name"], "a \"peg\"");
  EXPECT_EQ(json["environment"][0]["name"], "hole");
  EXPECT_EQ(json["environment"][0]["points_m"].size(), 24U);
  EXPECT_EQ(json["environment"][0]["triangles"].size(), 36U);
}

TEST(SceneJson, ManyTrianglesFitAPage) {
  Task task;
  Shape shape;
  shape.kind = Shape::Kind::kSolid;
  shape.solid = std::make_shared<Solid>(torus(300, 150));
  shape.size_m = shape.solid->size_m();
  task.environment.assign(4, shape);
  EXPECT_LT(scene_json(task).size(), 1'000'000U);
}

}  // namespace
}  // namespace tenon::drawing
