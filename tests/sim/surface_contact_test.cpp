// Contacts of bodies of triangles: the same as those of boxes and cylinders where they are the same
// bodies, exact where edges cross, and never forgotten.

#include "sim/physics/contacts/surface_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "shared/base/random.h"
#include "shared/geometry/extrusion.h"
#include "shared/geometry/mesh_file.h"
#include "shared/geometry/solid.h"
#include "sim/physics/contacts/contact_points.h"
#include "sim/physics/rollout/compliant_tool.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "sim/physics/scene.h"
#include "tests/support/example_parts.h"
#include "tests/support/meshes.h"

namespace tenon::sim {
namespace {

using tests::box_mesh;

Shape solid_shape(const std::string& name, const TriangleMesh& mesh, const Pose& pose) {
  const auto solid = std::make_shared<const Solid>(mesh);
  return {name, Shape::Kind::kSolid, solid->size_m(), pose, solid};
}

Pose at(double x, double y, double z, const Vector3& turn_rad = Vector3::Zero()) {
  return {{x, y, z}, rotation_of(turn_rad)};
}

/// A square pocket, 50 mm deep, its mouth at z = 0, in a plate of boxes.
std::vector<Shape> pocket(double width_m) {
  const double half_m = 0.5 * width_m;
  return {{"px", Shape::Kind::kBox, {0.05, 0.2, 0.05}, at(half_m + 0.025, 0, -0.025)},
          {"nx", Shape::Kind::kBox, {0.05, 0.2, 0.05}, at(-half_m - 0.025, 0, -0.025)},
          {"py", Shape::Kind::kBox, {0.2, 0.05, 0.05}, at(0, half_m + 0.025, -0.025)},
          {"ny", Shape::Kind::kBox, {0.2, 0.05, 0.05}, at(0, -half_m - 0.025, -0.025)},
          {"bottom", Shape::Kind::kBox, {0.2, 0.2, 0.02}, at(0, 0, -0.06)}};
}

std::vector<Shape> as_solids(std::vector<Shape> shapes) {
  for (Shape& shape : shapes) shape = solid_shape(shape.name, box_mesh(shape.size_m), shape.pose);
  return shapes;
}

Task task_of(const Shape& held, const std::vector<Shape>& environment) {
  Task task;
  task.held = {held};
  task.environment = environment;
  task.compliance.compliant_axes = 0b000111;  // as tasks in translation have it
  return task;
}

/// The same drawn moves in every world, each from where the one before ended in the first.
struct Worlds {
  std::vector<std::unique_ptr<OdeRollout>> rollouts;

  void expect_the_same_moves(int count, double stiffness_Npm) {
    Random random(7);
    Particle particle;
    particle.pose = at(0.002, -0.003, 0.02);
    particle.physics.contact_stiffness_Npm = stiffness_Npm;
    int contacts = 0;
    for (int i = 0; i < count; ++i) {
      MoveParameters move;
      move.compliance.compliant_axes = 0b000111;
      move.displacement.head<3>() << 0.03 * (random.uniform() - 0.5),
          0.03 * (random.uniform() - 0.5), 0.06 * (random.uniform() - 0.7);
      const RolloutResult first = rollouts.front()->simulate(particle, move, 1000, nullptr);
      ASSERT_TRUE(first.valid) << first.failure;
      contacts += first.move.outcome == Outcome::kContact;
      for (std::size_t w = 1; w < rollouts.size(); ++w) {
        const RolloutResult other = rollouts[w]->simulate(particle, move, 1000, nullptr);
        ASSERT_TRUE(other.valid) << other.failure;
        EXPECT_EQ(other.move.outcome, first.move.outcome) << "world " << w << ", move " << i;
        EXPECT_EQ(other.move.signature, first.move.signature) << "world " << w << ", move " << i;
        EXPECT_LT((other.move.pose.position_m - first.move.pose.position_m).norm(), 50e-6)
            << "world " << w << ", move " << i;
      }
      particle.pose = first.move.pose;
      particle.signature = first.move.signature;
      if (particle.pose.position_m.z() > 0.06)
        particle = {at(0.001, 0.0, 0.02), {}, particle.physics, {}};
    }
    EXPECT_GT(contacts, count / 8);
  }
};

TEST(SurfaceContact, ABoxOfTrianglesMovesAsABox) {
  const Vector3 size_m(0.04, 0.04, 0.08);
  const Pose pose = at(0, 0, 0.04);
  const Shape box{"peg", Shape::Kind::kBox, size_m, pose};
  const Shape solid = solid_shape("peg", box_mesh(size_m), pose);
  Worlds worlds;
  worlds.rollouts.push_back(std::make_unique<OdeRollout>(task_of(box, pocket(0.042))));
  worlds.rollouts.push_back(std::make_unique<OdeRollout>(task_of(solid, pocket(0.042))));
  worlds.rollouts.push_back(std::make_unique<OdeRollout>(task_of(solid, as_solids(pocket(0.042)))));
  worlds.expect_the_same_moves(60, 1e6);
}

TEST(SurfaceContact, ARoundPegIsTheSameAsCylinderExtrusionAndMesh) {
  constexpr double kRadius_m = 0.02;
  // The corners of 100 sides leave 10 um of the circle behind.
  const tests::Profile profile = tests::round_profile(kRadius_m, 100);
  const Pose pose = at(0, 0, 0.04);
  const Shape cylinder{"peg", Shape::Kind::kCylinder, {0.04, 0.04, 0.08}, pose};
  const Shape extrusion = solid_shape("peg", extruded(profile, 0.08), pose);
  const TriangleMesh loft = tests::lofted({{profile, -0.04}, {profile, 0.0}, {profile, 0.04}});
  const Shape mesh = solid_shape("peg", read_stl(tests::binary_stl(loft, 1e-3), 1e-3), pose);
  Worlds worlds;
  for (const Shape& peg : {cylinder, extrusion, mesh}) {
    worlds.rollouts.push_back(std::make_unique<OdeRollout>(task_of(peg, pocket(0.041))));
  }
  worlds.expect_the_same_moves(60, 1e6);
}

TEST(SurfaceContact, EdgesThatCrossTouchWhereTheyCross) {
  // A roof along x below, one along y above: their ridges cross anywhere between the corners.
  const TriangleMesh roof = extruded({{-0.01, 0.0}, {0.01, 0.0}, {0.0, 0.01}}, 0.1);
  const auto along_x = rotation_of({std::numbers::pi / 2, 0, 0});
  const Shape below = solid_shape(
      "below", roof, {Vector3::Zero(), rotation_of({0, 0, std::numbers::pi / 2}) * along_x});
  const Shape above = solid_shape(
      "above", roof, {Vector3::Zero(), rotation_of({std::numbers::pi, 0, 0}) * along_x});
  OdeWorld world;
  CompliantTool tool(world, {});
  Scene scene({above}, {below});
  scene.attach(tool.body());
  const double touching_m = 0.01;  // the height of a roof about its centre, twice
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const Vector3 off_m(0.08 * (random.uniform() - 0.5), 0.08 * (random.uniform() - 0.5), 0.0);
    const double depth_m = 1e-3 * (random.uniform() - 0.5);
    tool.place({off_m + Vector3(0, 0, touching_m - depth_m), Eigen::Quaterniond::Identity()});
    tool.show();
    scene.moved_anywhere();
    const Scene::Contacts found = scene.find_contacts(true);
    EXPECT_EQ(found.points > 0, depth_m > 0.0) << i;
    if (depth_m <= 0.0) {
      EXPECT_LE(scene.clearance_m(), -depth_m + 1e-9);
      EXPECT_GT(scene.clearance_m(), 0.0);
      continue;
    }
    // Upwards, not across either side.
    EXPECT_NEAR(found.depth_max_m, depth_m, 0.01 * depth_m);
    EXPECT_NEAR(scene.points().front().pos[0], off_m.x(), 1e-3);
    EXPECT_NEAR(scene.points().front().pos[1], 0.0, 1e-3);
  }
}

TEST(SurfaceContact, APegThatLiesAlongAWallAndBeyondItsRimIsPushedAwayFromTheWallAlone) {
  // The peg's edges leave the wall at its rim, where the top is as near as the wall itself.
  const Shape peg =
      solid_shape("peg", extruded(tests::round_profile(0.01, 60), 0.06), at(0, 0, 0.03));
  const Shape block = solid_shape("block", box_mesh({0.06, 0.06, 0.04}), at(0, 0, -0.02));
  OdeWorld world;
  CompliantTool tool(world, {});
  Scene scene({peg}, {block});
  scene.attach(tool.body());
  Random random(13);
  int rims = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3 turned_rad(4e-3 * (random.uniform() - 0.5), 4e-3 * (random.uniform() - 0.5),
                             0.2 * (random.uniform() - 0.5));
    tool.place(at(0.01 * random.uniform(), 0.03 + 0.01 - 3e-5 * random.uniform(),
                  -0.01 + 0.002 * random.uniform(), turned_rad));
    tool.show();
    scene.moved_anywhere();
    (void)scene.find_contacts(true);
    for (const dContactGeom& point : scene.points()) {
      EXPECT_GT(point.normal[1], 0.99) << i;
      EXPECT_LT(std::abs(point.normal[2]), 0.01) << i;
      rims += point.pos[2] > -1e-4;
    }
  }
  EXPECT_GT(rims, 1000);
}

TEST(SurfaceContact, NothingIsForgottenOnTheWay) {
  const Shape peg =
      solid_shape("peg", extruded(tests::round_profile(0.01, 30), 0.06), at(0, 0, 0.03));
  OdeWorld world;
  CompliantTool tool(world, {});
  Scene watched({peg}, as_solids(pocket(0.021)));
  Scene fresh({peg}, as_solids(pocket(0.021)));
  watched.attach(tool.body());
  fresh.attach(tool.body());
  Random random(9);
  Pose pose = at(0, 0, 0.001);
  int touched = 0;
  for (int i = 0; i < 3000; ++i) {
    Vector6 step;
    for (int axis = 0; axis < 3; ++axis) step[axis] = 2e-4 * (random.uniform() - 0.5);
    for (int axis = 3; axis < 6; ++axis) step[axis] = 4e-3 * (random.uniform() - 0.5);
    // About a place where the peg is a little in the pocket.
    step.head<3>() += 0.02 * (Vector3(0, 0, -0.002) - pose.position_m);
    step.tail<3>() -= 0.02 * rotation_vector(pose.orientation);
    const Pose next = displaced(pose, step);
    watched.moved(step.head<3>().norm() + watched.reach_m() * step.tail<3>().norm());
    pose = next;
    tool.place(pose);
    tool.show();
    fresh.moved_anywhere();
    (void)fresh.find_contacts(true);
    if (watched.clearance_m() > 0.0) {
      ASSERT_EQ(fresh.points().size(), 0U) << i;
      continue;
    }
    (void)watched.find_contacts(true);
    ASSERT_EQ(watched.points().size(), fresh.points().size()) << i;
    for (std::size_t p = 0; p < fresh.points().size(); ++p) {
      EXPECT_NEAR(watched.points()[p].depth, fresh.points()[p].depth, 1e-12);
    }
    touched += !fresh.points().empty();
    EXPECT_LE(fresh.points().size(), kPointsMax);
  }
  EXPECT_GT(touched, 200);
  EXPECT_LT(touched, 2900);
}

TEST(SurfaceContact, APartThatIsPutSomewhereTouchesAsIfNothingWereKnown) {
  const Shape peg =
      solid_shape("peg", extruded(tests::round_profile(0.01, 30), 0.06), at(0, 0, 0.03));
  OdeWorld world;
  CompliantTool tool(world, {});
  Scene watched({peg}, as_solids(pocket(0.021)));
  Scene fresh({peg}, as_solids(pocket(0.021)));
  watched.attach(tool.body());
  fresh.attach(tool.body());
  Random random(11);
  Pose pose = at(0, 0, 0.001);
  int touched = 0;
  for (int i = 0; i < 1500; ++i) {
    const bool far = i % 10 == 0;
    for (int axis = 0; axis < 3; ++axis) {
      pose.position_m[axis] += (far ? 5e-3 : 3e-4) * (random.uniform() - 0.5);
    }
    pose.position_m += (far ? 0.5 : 0.02) * (Vector3(0, 0, -0.002) - pose.position_m);
    pose.orientation = rotation_of({0.02 * random.uniform(), 0.0, 0.05 * random.uniform()});
    tool.place(pose);
    tool.show();
    watched.placed();
    fresh.moved_anywhere();
    if (i % 3 == 0) {
      EXPECT_EQ(watched.overlap_m(), fresh.overlap_m()) << i;
    }
    fresh.moved_anywhere();
    (void)watched.find_contacts(true);
    (void)fresh.find_contacts(true);
    ASSERT_EQ(watched.points().size(), fresh.points().size()) << i;
    for (std::size_t p = 0; p < fresh.points().size(); ++p) {
      // To the bit: what is known decides nothing.
      EXPECT_EQ(watched.points()[p].depth, fresh.points()[p].depth) << i;
      EXPECT_EQ(watched.points()[p].pos[2], fresh.points()[p].pos[2]) << i;
    }
    touched += !fresh.points().empty();
  }
  EXPECT_GT(touched, 300);
  EXPECT_LT(touched, 1450);
}

TEST(SurfaceContact, WhoHasFoundEnoughMayStopButSaysTheSame) {
  const auto parts = tests::example_parts();
  const auto drawn = [&](const std::string& name, const std::string& file) {
    const Shape shape = solid_shape(name, parts.at(file), {});
    return solid_shape(name, parts.at(file), {shape.solid->centre_m(), {1, 0, 0, 0}});
  };
  const Shape plug = drawn("plug", "keyed_peg.stl");
  const Shape socket = drawn("socket", "keyed_socket.stl");
  OdeWorld world;
  CompliantTool tool(world, {});
  Scene scene({plug}, {socket});
  scene.attach(tool.body());
  Random random(31);
  int deep = 0;
  for (int i = 0; i < 200; ++i) {
    const double reach_m = i % 2 == 0 ? 1e-3 : 20e-3;
    Pose pose = at(0, 0, i % 2 == 0 ? 0.001 : 0.02);
    for (int axis = 0; axis < 3; ++axis) {
      pose.position_m[axis] += 2.0 * reach_m * (random.uniform() - 0.5);
    }
    pose.orientation = rotation_of({0.05 * random.uniform(), 0.05 * random.uniform(), 0.0});
    tool.place(pose);
    tool.show();
    const double enough_m = 2e-3 * random.uniform();
    const double stopped_m = scene.overlap_m(enough_m);
    scene.moved_anywhere();
    const double whole_m = scene.overlap_m();
    EXPECT_LE(stopped_m, whole_m + 1e-12) << i;
    ASSERT_EQ(stopped_m > enough_m, whole_m > enough_m) << i;
    deep += whole_m > enough_m;
  }
  EXPECT_GT(deep, 40);
  EXPECT_LT(deep, 160);
}

TEST(SurfaceContact, ALargerPartStandsOutOnAllSides) {
  const Shape peg = solid_shape("peg", box_mesh({0.04, 0.04, 0.08}), at(0, 0, 0.04));
  OdeWorld world;
  CompliantTool tool(world, {});
  Scene scene({peg}, as_solids(pocket(0.041)));
  scene.attach(tool.body());
  tool.place(at(0, 0, -0.03));
  tool.show();
  EXPECT_EQ(scene.overlap_m(), 0.0);
  scene.set_oversize(0.0009);
  EXPECT_EQ(scene.overlap_m(), 0.0);
  scene.set_oversize(0.0014);
  EXPECT_NEAR(scene.overlap_m(), 0.0002, 1e-9);
  // As drawn so: by the size that a task gives it.
  Shape grown = peg;
  grown.size_m += Vector3::Constant(0.0014);
  Scene larger({grown}, pocket(0.041));
  larger.attach(tool.body());
  EXPECT_NEAR(larger.overlap_m(), 0.0002, 1e-9);
}

}  // namespace
}  // namespace tenon::sim
