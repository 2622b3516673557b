// Whether bodies with faces side by side are in each other: every edge of either may lie on the
// other's surface then. The same as for boxes, whatever the bodies are made of.

#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "shared/geometry/extrusion.h"
#include "shared/geometry/mesh_file.h"
#include "shared/geometry/solid.h"
#include "shared/ports/collision_depth.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "tests/support/meshes.h"

namespace tenon::sim {
namespace {

using tests::Profile;

enum class Kind { kBox, kExtrusion, kMesh };
constexpr std::array kKinds = {Kind::kBox, Kind::kExtrusion, Kind::kMesh};

Shape solid_shape(const TriangleMesh& mesh) {
  const auto solid = std::make_shared<const Solid>(mesh);
  return {"solid", Shape::Kind::kSolid, solid->size_m(), {}, solid};
}

Profile rectangle(double x_m, double y_m) {
  return {{-0.5 * x_m, -0.5 * y_m},
          {0.5 * x_m, -0.5 * y_m},
          {0.5 * x_m, 0.5 * y_m},
          {-0.5 * x_m, 0.5 * y_m}};
}

Shape body(Kind kind, const Vector3& size_m) {
  switch (kind) {
    case Kind::kBox:
      return {"box", Shape::Kind::kBox, size_m, {}};
    case Kind::kExtrusion:
      return solid_shape(extruded(rectangle(size_m.x(), size_m.y()), size_m.z()));
    case Kind::kMesh:
      return solid_shape(read_stl(tests::binary_stl(tests::box_mesh(size_m), 1e-3), 1e-3));
  }
  return {};
}

/// Of the held body, off by so much from the other's middle. @param turn of all of it
bool in_collision(const Shape& held, Shape environment, const Vector3& off_m,
                  const Eigen::Quaterniond& turn = Eigen::Quaterniond::Identity()) {
  environment.pose = {turn * Vector3(0.3, -0.2, 0.1), turn};
  Task task;
  task.held = {held};
  task.environment = {environment};
  return OdeRollout(task).in_collision({environment.pose.position_m + turn * off_m, turn});
}

/// As they are and turned, where hardly a number is what it was drawn as.
const std::vector<Eigen::Quaterniond>& turns() {
  static const std::vector<Eigen::Quaterniond> turns = {
      Eigen::Quaterniond::Identity(), rotation_of({0.0, 0.0, 0.5 * std::numbers::pi}),
      rotation_of({0.3, -0.7, 0.4}), rotation_of({-1.1, 0.2, 2.0})};
  return turns;
}

const Vector3 kSize_m(0.04, 0.04, 0.08);

/// Every way to be in or beside each other, of every two kinds.
void expect_everywhere(double depth_m, bool expected) {
  for (const Kind held : kKinds) {
    for (const Kind environment : kKinds) {
      for (int axis = 0; axis < 3; ++axis) {
        // Flush in two axes, in one, and in none.
        for (const double aside_m : {0.0, 0.01, -0.03}) {
          for (const double askew_m : {0.0, 0.007}) {
            Vector3 off_m;
            off_m[axis] = kSize_m[axis] - depth_m;
            off_m[(axis + 1) % 3] = aside_m;
            off_m[(axis + 2) % 3] = askew_m;
            for (const Eigen::Quaterniond& turn : turns()) {
              EXPECT_EQ(in_collision(body(held, kSize_m), body(environment, kSize_m), off_m, turn),
                        expected)
                  << static_cast<int>(held) << " in " << static_cast<int>(environment) << " at "
                  << 1e3 * off_m.transpose() << " mm, turned " << turn.coeffs().transpose();
            }
          }
        }
      }
    }
  }
}

TEST(FlushOverlap, IsSeenAtEveryDepth) {
  for (const double depth_m : {0.102e-3, 0.15e-3, 1e-3, 8e-3, 39.9e-3}) {
    expect_everywhere(depth_m, true);
  }
}

TEST(FlushOverlap, ATouchIsNone) {
  for (const double depth_m : {0.0, 1e-6, 0.5 * kCollisionDepth_m, 0.098e-3, -1e-6, -0.2e-3}) {
    expect_everywhere(depth_m, false);
  }
}

TEST(FlushOverlap, OneBodyIsInItself) {
  for (const Kind held : kKinds) {
    for (const Kind environment : kKinds) {
      for (const Eigen::Quaterniond& turn : turns()) {
        for (const Vector3& off_m : {Vector3(0, 0, 0), Vector3(0, 0, 0.01), Vector3(0, 0.01, 0),
                                     Vector3(0.02, 0, 0), Vector3(0.001, 0.001, 0.001)}) {
          EXPECT_TRUE(in_collision(body(held, kSize_m), body(environment, kSize_m), off_m, turn))
              << static_cast<int>(held) << " in " << static_cast<int>(environment) << " at "
              << 1e3 * off_m.transpose();
        }
      }
    }
  }
}

// No corner of either is in the other, and no triangle has its middle there.
TEST(FlushOverlap, ABarThroughABlockAsWideIsSeen) {
  const Vector3 bar_m(0.04, 0.2, 0.01);
  for (const Kind held : kKinds) {
    for (const Kind environment : kKinds) {
      for (const Eigen::Quaterniond& turn : turns()) {
        const Shape block = body(environment, kSize_m);
        EXPECT_TRUE(in_collision(body(held, bar_m), block, {0.0, 0.003, 0.0}, turn));
        EXPECT_TRUE(in_collision(body(held, bar_m), block, {0.0, 0.0, 0.035}, turn));
        EXPECT_FALSE(in_collision(body(held, bar_m), block, {0.0, 0.0, 0.045}, turn));
        EXPECT_FALSE(in_collision(body(held, bar_m), block, {0.04, 0.0, 0.0}, turn));
      }
    }
  }
}

TEST(FlushOverlap, RoundBodiesOnOneAxis) {
  const Profile profile = tests::round_profile(0.02, 100);
  const Shape cylinder{"cylinder", Shape::Kind::kCylinder, {0.04, 0.04, 0.08}, {}};
  const Shape mesh =
      solid_shape(tests::lofted({{profile, -0.04}, {profile, 0.0}, {profile, 0.04}}));
  const Shape extrusion = solid_shape(extruded(profile, 0.08));
  for (const Shape& held : {cylinder, mesh, extrusion}) {
    for (const Shape& environment : {mesh, extrusion}) {
      for (const Eigen::Quaterniond& turn : turns()) {
        EXPECT_TRUE(in_collision(held, environment, {0, 0, 0}, turn));
        EXPECT_TRUE(in_collision(held, environment, {0, 0, 0.02}, turn));
        EXPECT_TRUE(in_collision(held, environment, {0, 0, 0.0798}, turn));
        EXPECT_FALSE(in_collision(held, environment, {0, 0, 0.08}, turn));
        EXPECT_FALSE(in_collision(held, environment, {0.04, 0, 0}, turn));
      }
    }
  }
}

TEST(FlushOverlap, APlugFillsItsSlot) {
  const Profile slot = {{-0.04, -0.03}, {0.04, -0.03},  {0.04, 0.02},  {0.02, 0.02},
                        {0.02, -0.02},  {-0.02, -0.02}, {-0.02, 0.02}, {-0.04, 0.02}};
  const Shape socket = solid_shape(extruded(slot, 0.08));
  const Vector3 seat_m(0.0, 0.005, 0.0);  // the slot's middle, from that of the box around it
  for (const Kind held : kKinds) {
    for (const Eigen::Quaterniond& turn : turns()) {
      EXPECT_FALSE(in_collision(body(held, kSize_m), socket, seat_m, turn));
      EXPECT_FALSE(in_collision(body(held, {0.0399, 0.04, 0.08}), socket, seat_m, turn));
      EXPECT_TRUE(in_collision(body(held, {0.0404, 0.04, 0.08}), socket, seat_m, turn));
      EXPECT_TRUE(in_collision(body(held, kSize_m), socket, seat_m - Vector3(0, 0.002, 0), turn));
      EXPECT_TRUE(in_collision(body(held, kSize_m), socket, seat_m + Vector3(0.03, 0, 0), turn));
    }
  }
}

TEST(FlushOverlap, ALargerPartIsInWhatItWasBeside) {
  for (const Kind held : kKinds) {
    for (const Kind environment : kKinds) {
      Task task;
      task.held = {body(held, kSize_m)};
      task.environment = {body(environment, kSize_m)};
      const Pose beside{{0.0, 0.0403, 0.0}, Eigen::Quaterniond::Identity()};
      task.oversize_m = 0.5e-3;  // 0.25 mm on every side
      EXPECT_FALSE(OdeRollout(task).in_collision(beside));
      task.oversize_m = 1e-3;
      EXPECT_TRUE(OdeRollout(task).in_collision(beside));
    }
  }
}

}  // namespace
}  // namespace tenon::sim
