// A part is pushed against a wall that is as wide and as high as it is, and stands straight before
// it: whatever either is made of it stops there, as a box does.

#include <gtest/gtest.h>

#include "shared/geometry/solid.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "tests/support/meshes.h"

namespace tenon::sim {
namespace {

const Vector3 kSize_m(0.04, 0.04, 0.08);
constexpr double kGap_m = 2e-3;

Shape body(bool solid, const Pose& pose) {
  if (!solid) return {"box", Shape::Kind::kBox, kSize_m, pose};
  return {"solid", Shape::Kind::kSolid, kSize_m, pose,
          std::make_shared<const Solid>(tests::box_mesh(kSize_m))};
}

/// Moves from the gap before the wall. @param off_m from straight before it
void expect_stopped(bool held_solid, bool wall_solid, const Vector3& off_m, CoordinateMask axes) {
  Task task;
  task.held = {body(held_solid, {})};
  const Vector3 wall_m(0.0, kSize_m.y() + kGap_m, 0.0);
  task.environment = {body(wall_solid, {wall_m, Eigen::Quaterniond::Identity()})};
  task.compliance.compliant_axes = axes;
  OdeRollout rollout(task);
  Particle particle;
  particle.physics.contact_stiffness_Npm = 1e6;
  particle.pose.position_m = off_m;
  MoveParameters move;
  move.compliance.compliant_axes = axes;
  move.speeds.approach_mps = move.speeds.contact_mps = 0.02;
  move.displacement.y() = 20e-3;
  const RolloutResult result = rollout.simulate(particle, move, 1000, nullptr);
  ASSERT_TRUE(result.valid) << result.failure;
  EXPECT_EQ(result.move.outcome, Outcome::kContact) << 1e6 * off_m.transpose() << " um";
  EXPECT_NEAR(result.move.travelled.y(), kGap_m, 0.1e-3) << 1e6 * off_m.transpose() << " um";
}

TEST(FlushPush, StopsAtTheWall) {
  for (const auto& [held, wall] :
       {std::pair{false, false}, {true, false}, {false, true}, {true, true}}) {
    for (const double x_m : {0.0, 1e-6, -8e-6, 30e-6, 5e-3}) {
      for (const double z_m : {0.0, -1e-6, 8e-6, -30e-6, 5e-3}) {
        SCOPED_TRACE(std::to_string(held) + " against " + std::to_string(wall));
        expect_stopped(held, wall, {x_m, 0.0, z_m}, 0b000111);
      }
    }
  }
}

TEST(FlushPush, StopsAtTheWallWithTheWristYielding) {
  for (const auto& [held, wall] : {std::pair{true, false}, {true, true}}) {
    for (const double off_m : {0.0, 2e-6, -20e-6}) {
      SCOPED_TRACE(std::to_string(held) + " against " + std::to_string(wall));
      expect_stopped(held, wall, {off_m, 0.0, -off_m}, 0b111111);
    }
  }
}

}  // namespace
}  // namespace tenon::sim
