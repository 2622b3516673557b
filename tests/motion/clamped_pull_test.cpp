// A move whose contact nobody watches: spring and feed-forward together pull no harder than the
// force limit, and the impact no harder than the formula says.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shared/motion/guarded_move.h"
#include "shared/motion/stiff_contact.h"
#include "shared/ports/rollout.h"
#include "shared/task/task.h"
#include "sim/physics/rollout/ode_rollout.h"

namespace tenon {
namespace {

Task cube_over_a_floor() {
  Task task;
  task.held = {{"cube",
                Shape::Kind::kBox,
                Vector3::Constant(0.1),
                {{0.0, 0.0, 0.05}, Eigen::Quaterniond::Identity()}}};
  task.environment = {{"floor",
                       Shape::Kind::kBox,
                       {1.0, 1.0, 0.1},
                       {{0.0, 0.0, -0.05}, Eigen::Quaterniond::Identity()}}};
  task.compliance.compliant_axes = 0x07;
  return task;
}

// Down onto the floor, 10 mm below, at one speed all the way.
MoveParameters blind_press(const Task& task, double speed_mps) {
  MoveParameters move;
  move.compliance = task.compliance;
  move.displacement[2] = -0.1;
  move.speeds.approach_mps = move.speeds.contact_mps = speed_mps;
  move.trigger_mask = {};
  return move;
}

TEST(ClampedPull, ARolloutThatWatchesNothingStaysWithinLimitAndFormula) {
  const Task task = cube_over_a_floor();
  sim::OdeRollout rollout(task);
  Particle particle;
  particle.pose.position_m.z() = 0.01;
  for (const double speed_mps : {0.005, 0.01, 0.02, 0.05, 0.1}) {
    const MoveParameters move = blind_press(task, speed_mps);
    const RolloutResult result = rollout.simulate(particle, move, 2000, nullptr);
    ASSERT_TRUE(result.valid) << result.failure;
    const ContactLoop loop{.stiffness_Npm = particle.physics.contact_stiffness_Npm};
    const double formula_N =
        peak_force_N(loop, move.compliance, move.thresholds.force_on_N, speed_mps);
    EXPECT_LE(result.move.peak_force_N, std::max(formula_N, move.force_limit_N))
        << "at " << speed_mps << " m/s, by the formula " << formula_N;
    EXPECT_EQ(result.move.outcome, Outcome::kBlocked) << to_string(result.move.outcome);
  }
}

// What the law pulls with where the tool is held: K (xs - x) + D xs'.
TEST(ClampedPull, NothingPullsHarderThanTheLimitOnAToolThatIsHeld) {
  MoveParameters move;
  move.displacement[0] = 0.1;
  move.trigger_mask = {};
  GuardedMove guarded(move, {});
  GuardedMove::Input input;
  double most_N = 0.0;
  double fastest_mps = 0.0;
  for (int i = 0; i < 1000; ++i) {
    input.time_ns = 2'000'000 * i;
    // Free for 100 ms, then held by what pushes back as hard as is pulled.
    const GuardedMove::Output output = guarded.update(input);
    if (output.phase != GuardedMove::Phase::kMoving) break;
    const double lead_m = output.setpoint.pose.position_m.x() - input.pose.position_m.x();
    const double pull_N = move.compliance.stiffness_Npm * lead_m +
                          move.compliance.damping_Nspm * output.setpoint.velocity[0];
    if (i < 50) {
      input.pose = output.setpoint.pose;
      fastest_mps = output.setpoint.velocity[0];
    } else {
      input.wrench[0] = -pull_N;
      if (i > 50) most_N = std::max(most_N, pull_N);
    }
  }
  EXPECT_GT(fastest_mps, 0.02) << "the feed-forward was there while nothing pushed back";
  EXPECT_LE(most_N, move.force_limit_N * (1.0 + 1e-9));
}

}  // namespace
}  // namespace tenon
