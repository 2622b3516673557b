// A task from two part files: what is measured of them, and that the task is one.

#include <gtest/gtest.h>

#include <numbers>

#include "planner/new_task/part_fit.h"
#include "planner/new_task/task_text.h"
#include "shared/config/load.h"
#include "shared/config/part_file.h"
#include "shared/geometry/extrusion.h"
#include "shared/task/inserted.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "tests/support/example_parts.h"
#include "tests/support/meshes.h"
#include "tests/support/scratch_folder.h"

namespace tenon::planner {
namespace {

std::shared_ptr<const Solid> solid_of(TriangleMesh mesh, const Pose& pose = {}) {
  for (Vector3& point : mesh.points_m) point = pose.position_m + pose.orientation * point;
  return std::make_shared<const Solid>(std::move(mesh));
}

TriangleMesh round_peg(double radius_m) {
  const tests::Profile profile = tests::round_profile(radius_m, 48);
  return tests::lofted({{profile, 0.0}, {profile, 40e-3}});
}

/// A round hole of 20 mm in a round block.
TriangleMesh round_socket(double radius_m) {
  const tests::Profile hole = tests::round_profile(radius_m, 48);
  const tests::Profile block = tests::round_profile(25e-3, 48);
  return tests::lofted({{block, -5e-3}, {block, 20e-3}, {hole, 20e-3}, {hole, 0.0}});
}

TEST(NewTask, MeasuresHowAKeyedPegGoesIn) {
  const auto parts = tests::example_parts();
  const PartFit fit =
      fit_of(solid_of(parts.at("keyed_peg.stl")), solid_of(parts.at("keyed_socket.stl")), {});
  ASSERT_TRUE(fit.way_out.has_value());
  EXPECT_LT((*fit.way_out - Vector3::UnitZ()).norm(), 1e-9);
  EXPECT_NEAR(fit.depth_m, 30e-3, 1.5e-3);  // less what the chamfers leave free
  EXPECT_NEAR(fit.play_m[0], 1e-3, 0.02e-3);
  EXPECT_NEAR(fit.play_m[1], 1e-3, 0.02e-3);
  EXPECT_TRUE(fit.yaw_matters);
}

// All edges of the one lie on the other's surface then.
TEST(NewTask, SeesPartsOneInTheOtherThatAreFlush) {
  const Vector3 size_m(40e-3, 40e-3, 80e-3);
  const auto overlap_m = [&](const Vector3& off_m) {
    const auto body = solid_of(tests::box_mesh(size_m));
    return fit_of(body, body, {off_m, Eigen::Quaterniond::Identity()}).overlap_m;
  };
  EXPECT_NEAR(overlap_m({0.0, 0.0, 0.0}), 40e-3, 10e-3);
  for (const double deep_m : {0.1e-3, 1e-3, 8e-3}) {
    EXPECT_NEAR(overlap_m({40e-3 - deep_m, 0.0, 0.0}), deep_m, 1e-9);
    EXPECT_NEAR(overlap_m({0.0, 0.0, 80e-3 - deep_m}), deep_m, 1e-9);
    EXPECT_NEAR(overlap_m({10e-3, 40e-3 - deep_m, 0.0}), deep_m, 1e-9);
  }
  EXPECT_EQ(overlap_m({40e-3, 0.0, 0.0}), 0.0);
  EXPECT_EQ(overlap_m({10e-3, 0.0, 80e-3}), 0.0);
  const auto peg = solid_of(round_peg(10e-3));
  EXPECT_GT(fit_of(peg, peg, {}).overlap_m, 10e-3);
}

TEST(NewTask, ARoundPegMayTurn) {
  const PartFit fit = fit_of(solid_of(round_peg(10e-3)), solid_of(round_socket(10.3e-3)), {});
  ASSERT_TRUE(fit.way_out.has_value());
  EXPECT_FALSE(fit.yaw_matters);
  EXPECT_NEAR(fit.depth_m, 20e-3, 0.6e-3);
  EXPECT_NEAR(fit.play_m[0], 0.6e-3, 0.05e-3);
}

TEST(NewTask, BeyondAWallThereIsNoPlay) {
  // So long a plug that it would be free again on the other side of the thin wall.
  const tests::Profile peg = tests::round_profile(4e-3, 48);
  const tests::Profile hole = tests::round_profile(4.3e-3, 48);
  const tests::Profile tube = tests::round_profile(8e-3, 48);
  const auto socket = tests::lofted({{tube, -5e-3}, {tube, 20e-3}, {hole, 20e-3}, {hole, 0.0}});
  const PartFit fit =
      fit_of(solid_of(tests::lofted({{peg, 0.0}, {peg, 50e-3}})), solid_of(socket), {});
  EXPECT_NEAR(fit.play_m[0], 0.6e-3, 0.05e-3);
  EXPECT_NEAR(fit.depth_m, 20e-3, 0.6e-3);
}

TEST(NewTask, TheWayOutNeedNotBeUp) {
  const Pose askew{{0.01, -0.02, 0.3}, rotation_of({0.0, 2.0, 0.0})};
  // The plug is in its own frame; where it stands in the socket's is said.
  const PartFit fit =
      fit_of(solid_of(round_peg(10e-3)), solid_of(round_socket(10.3e-3), askew), askew);
  ASSERT_TRUE(fit.way_out.has_value());
  EXPECT_LT((*fit.way_out - askew.orientation * Vector3::UnitZ()).norm(), 1e-6);
  EXPECT_NEAR(fit.depth_m, 20e-3, 0.6e-3);
}

// What the files' axes are is nobody's choice: those of the task go straight out of the sides.
TEST(NewTask, TheAxesAreThoseOfTheSidesHoweverTheFilesAreTurned) {
  const auto parts = tests::example_parts();
  const auto fit_turned = [&](const Eigen::Quaterniond& turn) {
    const Pose pose{{0.01, 0.02, 0.03}, turn};
    return fit_of(solid_of(parts.at("keyed_peg.stl"), pose),
                  solid_of(parts.at("keyed_socket.stl"), pose), {});
  };
  EXPECT_TRUE(
      fit_turned(Eigen::Quaterniond::Identity()).frame.isApprox(Eigen::Quaterniond::Identity()));
  for (const Vector3& turn_rad :
       {Vector3{0.0, 0.0, 0.43}, Vector3{0.0, 0.0, -0.6}, Vector3{0.5, 0.3, 0.9}}) {
    const Eigen::Quaterniond turn = rotation_of(turn_rad);
    const PartFit fit = fit_turned(turn);
    ASSERT_TRUE(fit.way_out.has_value());
    const Vector3 x = turn.conjugate() * fit.frame * Vector3::UnitX();
    EXPECT_NEAR(x.cwiseAbs().maxCoeff(), 1.0, 1e-5) << turn_rad.transpose();
    EXPECT_TRUE((fit.frame * Vector3::UnitZ()).isApprox(*fit.way_out, 1e-9));
    EXPECT_NEAR(fit.play_m[0], 1e-3, 0.02e-3);
    EXPECT_NEAR(fit.play_m[1], 1e-3, 0.02e-3);
  }
}

// No facet of what is round is a side to push against.
TEST(NewTask, TheAxesOfRoundPartsAreThoseOfTheirFiles) {
  const Pose turned{Vector3::Zero(), rotation_of({0.0, 0.0, 0.031})};
  const PartFit fit =
      fit_of(solid_of(round_peg(10e-3), turned), solid_of(round_socket(10.3e-3), turned), {});
  EXPECT_TRUE(fit.frame.isApprox(Eigen::Quaterniond::Identity()));
}

TEST(NewTask, SaysWhatOverlapsAndWhatIsLockedIn) {
  const PartFit tight = fit_of(solid_of(round_peg(10.5e-3)), solid_of(round_socket(10.3e-3)), {});
  EXPECT_NEAR(tight.overlap_m, 0.2e-3, 0.05e-3);
  EXPECT_FALSE(tight.way_out.has_value());

  // A ball in a hollow.
  TriangleMesh hollow = tests::turned_about(tests::box_mesh({20e-3, 20e-3, 20e-3}));
  const auto box = solid_of(tests::together(tests::box_mesh({40e-3, 40e-3, 40e-3}), hollow));
  const PartFit locked = fit_of(solid_of(tests::box_mesh({15e-3, 15e-3, 15e-3})), box, {});
  EXPECT_EQ(locked.overlap_m, 0.0);
  EXPECT_FALSE(locked.way_out.has_value());
}

/// Two parts' files, the keyed peg's where no others are given, and the task that is written for
/// them.
struct Written {
  explicit Written(double uniform_rad)
      : Written(uniform_rad, tests::example_parts().at("keyed_peg.stl"),
                tests::example_parts().at("keyed_socket.stl")) {}

  Written(double uniform_rad, const TriangleMesh& plug_mesh, const TriangleMesh& socket_mesh) {
    const auto peg = folder.put("peg.stl", tests::binary_stl(plug_mesh, 1e-3));
    const auto socket = folder.put("socket.obj", tests::obj(socket_mesh, 1.0));
    const config::PartFile plug_file = config::load_part(peg);
    const config::PartFile socket_file = config::load_part(socket);
    task.name = "new";
    task.plug = {"peg.stl", plug_file.scale_m, plug_file.longest_raw, plug_file.solid};
    task.socket = {"socket.obj", socket_file.scale_m, socket_file.longest_raw, socket_file.solid};
    task.uniform_rad = uniform_rad;
    task.fit = fit_of(task.plug.solid, task.socket.solid, task.X_SP);
    file = folder.put("new.yaml", task_text(task));
  }

  tests::ScratchFolder folder;
  NewTask task;
  std::filesystem::path file;
};

TEST(NewTask, IsATaskWithFreeStartAndGoal) {
  const Written written(0.0);
  EXPECT_EQ(written.task.plug.scale_m, 1e-3);
  EXPECT_EQ(written.task.socket.scale_m, 1.0);
  const Task task = load_task(written.file);
  EXPECT_EQ(task.coordinates, 0b000111);
  sim::OdeRollout physics(task);
  EXPECT_FALSE(physics.in_collision(task.goal));
  const Start& start = task.starts.front();
  for (const double x_m : {-2e-3, 2e-3}) {
    for (const double z_m : {-2e-3, 2e-3}) {
      Vector6 off = Vector6::Zero();
      off[0] = x_m;
      off[2] = z_m;
      EXPECT_FALSE(physics.in_collision(displaced(start.pose, off)));
    }
  }
  // A side of the hole is where it was: beyond the play it is met.
  Vector6 aside = Vector6::Zero();
  aside[0] = 0.9e-3;
  EXPECT_TRUE(physics.in_collision(displaced(task.goal, aside)));
  EXPECT_EQ(task.errors, Distribution::kUniform);
  EXPECT_NEAR(task.particle_sigmas * start.sigma[0], 2e-3, 1e-12);
}

TEST(NewTask, TurnsWhereAskedTo) {
  const Written written(0.05);
  const Task task = load_task(written.file);
  EXPECT_EQ(task.coordinates, 0b111111);
  EXPECT_GT(task.starts.front().sigma[5], 0.0);
  sim::OdeRollout physics(task);
  EXPECT_FALSE(physics.in_collision(task.goal));
}

// As uncertain as the others, since touches meet what is turned; at the goal any will do.
TEST(NewTask, ARoundPegsYawIsUncertainAndFreeAtTheGoal) {
  const Written written(0.05, round_peg(10e-3), round_socket(10.3e-3));
  const Task task = load_task(written.file);
  EXPECT_EQ(task.coordinates, 0b111111);
  EXPECT_GT(task.starts.front().sigma[5], 0.0);
  EXPECT_EQ(task.goal_axes.free, 0b100000);
  EXPECT_FALSE(
      load_task(Written(0.0, round_peg(10e-3), round_socket(10.3e-3)).file).goal_axes.any());
}

// A part that stands askew by all that its hole leaves it has gone in, and one that is farther
// askew than that by half again has not.
TEST(NewTask, TheGoalTakesWhateverAngleTheHoleLeaves) {
  const Written written(0.05);
  const PartFit& fit = written.task.fit;
  EXPECT_NEAR(fit.turn_rad[0], 1e-3 / 30e-3, 3e-3);
  EXPECT_NEAR(fit.turn_rad[1], 1e-3 / 30e-3, 3e-3);
  EXPECT_GT(fit.turn_rad[2], 0.01);
  const Task task = load_task(written.file);
  sim::OdeRollout physics(task);
  for (int axis = 3; axis < 6; ++axis) {
    const double most_rad = fit.turn_rad[static_cast<std::size_t>(axis - 3)];
    EXPECT_NEAR(task.goal_axes.tolerance[axis], 2.0 * most_rad, 1e-3);
    EXPECT_TRUE(within_tolerance(task, displaced(task.goal, most_rad * Vector6::Unit(axis))));
    EXPECT_TRUE(physics.in_collision(displaced(task.goal, 1.5 * most_rad * Vector6::Unit(axis))));
  }
}

TEST(NewTask, ATurningPartIsHeldAboveItsChamfer) {
  const auto tip_m = [](const Written& written) {
    const Shape plug = load_task(written.file).held.front();
    return plug.pose.position_m.z() - 0.5 * plug.size_m.z();
  };
  EXPECT_NEAR(tip_m(Written(0.0)), 0.0, 1e-9);
  EXPECT_NEAR(tip_m(Written(0.05)), -5e-3, 1e-9);
}

TEST(NewTask, YawThatDoesNotMatterIsFreeAndDoesNotYield) {
  const Task keyed = load_task(Written(0.05).file);
  EXPECT_EQ(keyed.goal_axes.free, 0);
  EXPECT_EQ(keyed.compliance.compliant_axes, 0b111111);
  const Written written(0.05, round_peg(10e-3), round_socket(10.3e-3));
  const Task round = load_task(written.file);
  EXPECT_EQ(round.goal_axes.free, 0b100000);
  EXPECT_EQ(round.compliance.compliant_axes, 0b011111);
}

TEST(NewTask, SaysWhatItMeasured) {
  const Written written(0.0);
  const std::string said = findings(written.task);
  EXPECT_NE(said.find("peg.stl, taken to be in millimetres"), std::string::npos) << said;
  EXPECT_NE(said.find("socket.obj, taken to be in metres"), std::string::npos) << said;
  EXPECT_NE(said.find("insertion: along (0, 0, -1)"), std::string::npos) << said;
  EXPECT_NE(said.find("yaw: matters"), std::string::npos) << said;
}

}  // namespace
}  // namespace tenon::planner
