// A peg meets the rim of a cup at full contact speed, half beside it, and is drawn off again: what
// it has sunk in by at the impact, in one step, is not taken for a wall at its side.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "shared/base/random.h"
#include "shared/geometry/solid.h"
#include "sim/physics/rollout/compliant_tool.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "sim/physics/scene.h"
#include "tests/support/meshes.h"

namespace tenon::sim {
namespace {

constexpr double kRim_m = 11e-3;
constexpr double kPush_m = 10e-3;
constexpr double kDraw_m = 3e-3;
constexpr double kStiffness_Npm = 1e6;  // of the parts: the arm does not give way

Shape solid_shape(const char* name, const TriangleMesh& mesh) {
  const auto solid = std::make_shared<const Solid>(mesh);
  return {name,
          Shape::Kind::kSolid,
          solid->size_m(),
          {solid->centre_m(), Eigen::Quaterniond::Identity()},
          solid};
}

Task peg_over_cup() {
  using tests::round_profile;
  Task task;
  task.held = {solid_shape(
      "peg", tests::lofted({{round_profile(4e-3, 48), 0.0}, {round_profile(4e-3, 48), 30e-3}}))};
  task.environment = {solid_shape("cup", tests::lofted({{round_profile(6.4e-3, 48), 0.0},
                                                        {round_profile(6.4e-3, 48), kRim_m},
                                                        {round_profile(4.4e-3, 48), kRim_m},
                                                        {round_profile(4.4e-3, 48), 2e-3}}))};
  return task;
}

MoveParameters straight(double z_m) {
  MoveParameters move;
  move.compliance.compliant_axes = 0b000111;
  move.displacement.z() = z_m;
  return move;
}

TEST(Impact, NothingSinksInBeforeItIsNoticedAndAPegIsDrawnOffTheRimAgain) {
  const Task task = peg_over_cup();
  OdeRollout rollout(task);
  OdeWorld world;
  CompliantTool tool(world, {});
  Scene scene(task.held, task.environment);
  scene.attach(tool.body());
  Random random(5);
  double deepest_m = 0.0;
  for (int i = 0; i < 30; ++i) {
    const double aside_m = 1e-3 + 5e-3 * random.uniform();
    const double angle = 2.0 * std::numbers::pi * random.uniform();
    Particle particle;
    particle.physics.friction = 0.6;
    particle.physics.contact_stiffness_Npm = kStiffness_Npm;
    particle.pose.position_m << aside_m * std::cos(angle), aside_m * std::sin(angle),
        kRim_m + 3e-3 + 1e-4 * random.uniform();
    std::vector<TraceSample> trace;
    const RolloutResult met = rollout.simulate(particle, straight(-kPush_m), 2000, &trace);
    ASSERT_TRUE(met.valid) << i << ": " << met.failure;
    EXPECT_EQ(met.move.outcome, Outcome::kContact) << i;
    EXPECT_NEAR(met.move.pose.position_m.z(), kRim_m, 0.1e-3) << i << ", " << 1e3 * aside_m;
    for (const TraceSample& sample : trace) {
      if (sample.input.pose.position_m.z() > kRim_m) continue;
      tool.place(sample.input.pose);
      tool.show();
      deepest_m = std::max(deepest_m, scene.overlap_m());
    }
    particle.pose = met.move.pose;
    particle.signature = met.move.signature;
    const RolloutResult off = rollout.simulate(particle, straight(kDraw_m), 2000, nullptr);
    ASSERT_TRUE(off.valid) << i << ": " << off.failure;
    EXPECT_EQ(off.move.signature, ContactSignature{}) << i << ", " << 1e3 * aside_m << " mm aside";
    EXPECT_NEAR(off.move.travelled.z(), kDraw_m, 0.3e-3) << i << ", " << 1e3 * aside_m;
  }
  // What the tool's damper presses it in by at that speed, D v / k, less than the 0.1 mm of a step.
  const MoveParameters move = straight(-kPush_m);
  EXPECT_LE(deepest_m, move.compliance.damping_Nspm * move.speeds.contact_mps / kStiffness_Npm);
  EXPECT_GT(deepest_m, 1e-6);
}

}  // namespace
}  // namespace tenon::sim
