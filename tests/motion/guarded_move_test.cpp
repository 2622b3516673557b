// The guarded move against a world that is a formula: a tool that follows its setpoint through a
// first-order compliance, and flat walls with a stiffness.

#include "shared/motion/guarded_move.h"

#include <gtest/gtest.h>

#include <cstring>
#include <optional>
#include <vector>

#include "shared/ports/rollout.h"
#include "shared/task/task.h"
#include "sim/physics/rollout/ode_rollout.h"

namespace tenon {
namespace {

constexpr std::int64_t kStep_ns = 2'000'000;

// D x' = D xs' + K (xs - x) + f with f from walls at +x and -x; the other axes are free. Between
// two setpoints it interpolates, as drives do.
class FormulaWorld {
 public:
  double wall_plus_x_m = 1e9;
  double wall_stiffness_Npm = 5e4;
  std::optional<double> gone_beyond_y_m;  ///< the wall ends here: nothing pushes beyond

  GuardedMove::Input input(std::int64_t time_ns) const {
    GuardedMove::Input input;
    input.time_ns = time_ns;
    input.pose = pose;
    input.wrench[0] = force_N();
    return input;
  }
  void follow(const GuardedMove::Setpoint& setpoint, const Compliance& compliance) {
    constexpr int kSubsteps = 50;
    const double dt_s = 1e-9 * kStep_ns / kSubsteps;
    for (int i = 0; i < kSubsteps; ++i) {
      Vector3 force(force_N(), 0.0, 0.0);
      const double ahead_s = dt_s * (kSubsteps - i);
      const Vector3 now_m = setpoint.pose.position_m - ahead_s * setpoint.velocity.head<3>();
      const Vector3 spring = compliance.stiffness_Npm * (now_m - pose.position_m) + force;
      pose.position_m += dt_s * (setpoint.velocity.head<3>() + spring / compliance.damping_Nspm);
    }
  }
  double force_N() const {
    if (gone_beyond_y_m && pose.position_m.y() > *gone_beyond_y_m) return 0.0;
    return -wall_stiffness_Npm * std::max(0.0, pose.position_m.x() - wall_plus_x_m);
  }
  Pose pose;
};

GuardedMove::Result run(FormulaWorld& world, const MoveParameters& move,
                        ContactSignature signature = {},
                        std::vector<TraceSample>* trace = nullptr) {
  GuardedMove guarded(move, signature);
  for (std::int64_t t_ns = 0;; t_ns += kStep_ns) {
    const GuardedMove::Input input = world.input(t_ns);
    const GuardedMove::Output output = guarded.update(input);
    if (trace != nullptr) trace->push_back({input, output.setpoint});
    if (output.phase == GuardedMove::Phase::kDone) return *guarded.result();
    world.follow(output.setpoint, move.compliance);
  }
}

MoveParameters along(double x_m, double y_m) {
  MoveParameters move;
  move.displacement[0] = x_m;
  move.displacement[1] = y_m;
  return move;
}

TEST(GuardedMove, ReachesTheEndOfAFreePath) {
  FormulaWorld world;
  const auto result = run(world, along(0.1, -0.05));
  EXPECT_EQ(result.outcome, Outcome::kReached);
  EXPECT_EQ(result.signature, ContactSignature{});
  EXPECT_NEAR(result.travelled[0], 0.1, 1e-6);
  EXPECT_NEAR(result.travelled[1], -0.05, 1e-6);
}

TEST(GuardedMove, StopsAtAWallWithItsBitAndRestsUnderTheKeepForce) {
  FormulaWorld world;
  world.wall_plus_x_m = 0.04;
  const MoveParameters move = along(0.1, 0.0);
  const auto result = run(world, move);
  EXPECT_EQ(result.outcome, Outcome::kContact);
  EXPECT_EQ(to_string(result.signature), "-x");
  EXPECT_NEAR(world.force_N(), -move.thresholds.force_keep_N, 0.5);
  EXPECT_NEAR(result.travelled[0], 0.04, 0.2e-3);
}

TEST(GuardedMove, IsBlockedWhereTheContactIsNotWatched) {
  FormulaWorld world;
  world.wall_plus_x_m = 0.04;
  MoveParameters move = along(0.1, 0.0);
  move.trigger_mask = {};
  const auto result = run(world, move);
  EXPECT_EQ(result.outcome, Outcome::kBlocked);
  EXPECT_LT(result.peak_force_N, move.force_limit_N + 0.5);
}

TEST(GuardedMove, ReportsReleaseWhereTheWallEnds) {
  FormulaWorld world;
  world.wall_plus_x_m = 0.0;
  world.gone_beyond_y_m = 0.03;
  world.pose.position_m.x() = 3.0 / world.wall_stiffness_Npm;
  const auto result = run(world, along(0.0, 0.1), ContactSignature{ContactSignature::bit(0, -1)});
  EXPECT_EQ(result.outcome, Outcome::kRelease);
  EXPECT_EQ(result.signature, ContactSignature{});
  EXPECT_GT(result.travelled[1], 0.03);
  EXPECT_LT(result.travelled[1], 0.032);
}

TEST(GuardedMove, TimesOutInTimeAndSaysSo) {
  FormulaWorld world;
  MoveParameters move = along(0.1, 0.0);
  move.timeout_us = 500'000;
  const auto result = run(world, move);
  EXPECT_EQ(result.outcome, Outcome::kTimeout);
  EXPECT_EQ(result.decided_ns, 500'000'000);
}

TEST(GuardedMove, DropsWhatPushesIntoAHeldContact) {
  FormulaWorld world;
  world.wall_plus_x_m = 0.0;
  world.pose.position_m.x() = 3.0 / world.wall_stiffness_Npm;
  const auto result = run(world, along(0.1, 0.05), ContactSignature{ContactSignature::bit(0, -1)});
  EXPECT_EQ(result.outcome, Outcome::kReached);
  EXPECT_NEAR(result.travelled[0], 0.0, 1e-4);
  EXPECT_NEAR(result.travelled[1], 0.05, 1e-6);
  EXPECT_EQ(to_string(result.signature), "-x");
}

TEST(GuardedMove, ADepartingMoveTravelsItsWholeDisplacement) {
  FormulaWorld world;
  world.wall_plus_x_m = 0.0;
  world.pose.position_m.x() = 3.0 / world.wall_stiffness_Npm;
  const auto result = run(world, along(-0.05, 0.0), ContactSignature{ContactSignature::bit(0, -1)});
  EXPECT_EQ(result.outcome, Outcome::kReached);
  EXPECT_EQ(result.signature, ContactSignature{});
  EXPECT_NEAR(result.travelled[0], -0.05, 0.1e-3);
}

TEST(GuardedMove, GoesOnAfterAPushThatDoesNotLast) {
  FormulaWorld world;
  GuardedMove guarded(along(0.1, 0.0), {});
  int probing = 0;
  std::int64_t t_ns = 0;
  for (;; t_ns += kStep_ns) {
    GuardedMove::Input input = world.input(t_ns);
    // Two samples, 4 ms: shorter than the debounce.
    if (t_ns == 600'000'000 || t_ns == 602'000'000) input.wrench[0] = -15.0;
    const auto output = guarded.update(input);
    probing += output.phase == GuardedMove::Phase::kProbing;
    if (output.phase == GuardedMove::Phase::kDone) break;
    world.follow(output.setpoint, Compliance{});
  }
  EXPECT_EQ(probing, 2);
  EXPECT_EQ(guarded.result()->outcome, Outcome::kReached);
  EXPECT_NEAR(guarded.result()->travelled[0], 0.1, 0.1e-3);
}

// A tool jammed by friction: for a moment more than the on-threshold, then a little less for good.
TEST(GuardedMove, DoesNotWaitForAContactThatRestsBelowItsThreshold) {
  MoveParameters move = along(0.1, 0.0);
  move.timeout_us = 5'000'000;
  GuardedMove guarded(move, {});
  FormulaWorld world;
  const double on_N = move.thresholds.force_on_N;
  for (std::int64_t t_ns = 0; !guarded.result(); t_ns += kStep_ns) {
    GuardedMove::Input input = world.input(t_ns);
    const bool struck = input.pose.position_m.x() >= 0.02;
    if (struck) input.wrench[0] = -0.95 * on_N;
    if (struck && world.wall_plus_x_m > 1.0) {
      input.wrench[0] = -1.05 * on_N;
      world.wall_plus_x_m = 0.02;
      world.wall_stiffness_Npm = 1e9;
    }
    const auto setpoint = guarded.update(input).setpoint;
    if (!struck) world.follow(setpoint, move.compliance);
  }
  EXPECT_EQ(guarded.result()->outcome, Outcome::kBlocked);
}

TEST(GuardedMove, StaleSamplesDoNotFillTheDebounce) {
  // time     0   2   4   6   8  ms
  // force   -15 (the same sample again: not fresh)
  GuardedMove guarded(along(0.1, 0.0), {});
  FormulaWorld world;
  GuardedMove::Input input = world.input(0);
  input.wrench[0] = -15.0;
  (void)guarded.update(input);
  input.wrench_fresh = false;
  for (int i = 1; i < 20; ++i) {
    input.time_ns = i * kStep_ns;
    (void)guarded.update(input);
  }
  EXPECT_EQ(guarded.phase(), GuardedMove::Phase::kProbing);
  EXPECT_EQ(guarded.signature(), ContactSignature{});
}

bool same_bits(const GuardedMove::Setpoint& a, const GuardedMove::Setpoint& b) {
  return a.pose == b.pose && a.velocity == b.velocity && a.acceleration == b.acceleration;
}

TEST(GuardedMove, AReplayedTraceGivesTheSameBits) {
  FormulaWorld world;
  world.wall_plus_x_m = 0.04;
  const MoveParameters move = along(0.1, 0.02);
  std::vector<TraceSample> trace;
  const auto first = run(world, move, {}, &trace);
  GuardedMove again(move, {});
  for (const TraceSample& sample : trace) {
    EXPECT_TRUE(same_bits(again.update(sample.input).setpoint, sample.setpoint));
  }
  ASSERT_TRUE(again.result());
  EXPECT_EQ(again.result()->outcome, first.outcome);
  EXPECT_EQ(again.result()->decided_ns, first.decided_ns);
  EXPECT_EQ(again.result()->travelled, first.travelled);
}

TEST(GuardedMove, ALowerThresholdFiresEarlierOnTheSameTrace) {
  FormulaWorld world;
  world.wall_plus_x_m = 0.04;
  world.wall_stiffness_Npm = 5e3;
  MoveParameters move = along(0.1, 0.0);
  std::vector<TraceSample> trace;
  const auto first = run(world, move, {}, &trace);
  move.thresholds.force_on_N = 4.0;
  GuardedMove again(move, {});
  for (const TraceSample& sample : trace) (void)again.update(sample.input);
  ASSERT_TRUE(again.result());
  EXPECT_LT(again.result()->decided_ns, first.decided_ns);
}

// --- in ODE ---

Task slab(double ends_at_y_m) {
  Task task;
  task.held = {{"box",
                Shape::Kind::kBox,
                Vector3::Constant(0.1),
                {{0.0, 0.0, 0.05}, Eigen::Quaterniond::Identity()}}};
  task.environment = {{"slab",
                       Shape::Kind::kBox,
                       {1.0, 1.0, 0.1},
                       {{0.0, ends_at_y_m - 0.5, -0.05}, Eigen::Quaterniond::Identity()}}};
  task.compliance.compliant_axes = 0x07;
  return task;
}

TEST(OdeRollout, SlidingOffALedgeIsARelease) {
  const Task task = slab(0.0);
  sim::OdeRollout rollout(task);
  Particle particle;
  particle.pose.position_m = {0.0, -0.05, 0.01};
  MoveParameters move;
  move.compliance = task.compliance;
  move.displacement[2] = -0.05;
  auto result = rollout.simulate(particle, move, 2000, nullptr);
  ASSERT_TRUE(result.valid) << result.failure;
  ASSERT_EQ(result.move.outcome, Outcome::kContact);
  EXPECT_EQ(result.touching, std::vector<std::string>{"box-slab"});

  particle.pose = result.move.pose;
  particle.signature = result.move.signature;
  move.displacement << 0.0, 0.2, 0.0, 0.0, 0.0, 0.0;
  result = rollout.simulate(particle, move, 2000, nullptr);
  ASSERT_TRUE(result.valid) << result.failure;
  EXPECT_EQ(result.move.outcome, Outcome::kRelease);
  EXPECT_NEAR(result.move.travelled[1], 0.1, 3e-3);
}

// A tool that runs in deep, seen late, is pushed out again: where it turns back it stands still.
//
//   depth  |    _      turns back here: as deep 20 ms ago as now
//          |  /   \__
//          |_/       \____________ rests under the keep force
TEST(OdeRollout, WhereATurningToolStandsStillItIsNotAtRest) {
  const Task task = slab(0.5);
  sim::OdeRollout rollout(task);
  for (const double latency_s : {0.0, 0.004, 0.01}) {
    for (int i = 0; i < 40; ++i) {
      Particle particle;
      particle.physics.latency_s = latency_s;
      particle.pose.position_m = {0.0, 0.0, 0.01 + 1e-4 * i};
      MoveParameters move;
      move.compliance = task.compliance;
      move.compliance.mass_kg = 2.0;
      move.compliance.damping_Nspm = 1500.0;
      move.compliance.stiffness_Npm = 1000.0;
      move.thresholds.force_on_N = 9.0;
      move.thresholds.force_keep_N = 3.0;
      move.thresholds.force_off_N = 1.5;
      move.speeds.contact_mps = move.speeds.approach_mps = 0.05;
      move.displacement[2] = -0.05;
      const auto result = rollout.simulate(particle, move, 2000, nullptr);
      ASSERT_EQ(result.move.outcome, Outcome::kContact);
      const double pressed_N =
          -result.move.pose.position_m.z() * particle.physics.contact_stiffness_Npm;
      EXPECT_NEAR(pressed_N, move.thresholds.force_keep_N, 1.0) << latency_s << ", " << i;
    }
  }
}

TEST(OdeRollout, RepeatsItselfBitForBitInAnyOrderAndInstance) {
  const Task task = slab(0.5);
  sim::OdeRollout rollout(task);
  Particle particle;
  particle.pose.position_m = {0.0, 0.0, 0.02};
  MoveParameters down;
  down.compliance = task.compliance;
  down.displacement[2] = -0.05;
  MoveParameters aside = down;
  aside.displacement << 0.03, 0.01, 0.0, 0.0, 0.0, 0.0;
  const auto first = rollout.simulate(particle, down, 2000, nullptr);
  (void)rollout.simulate(particle, aside, 2000, nullptr);
  const auto again = rollout.simulate(particle, down, 2000, nullptr);
  const auto other = rollout.clone()->simulate(particle, down, 2000, nullptr);
  ASSERT_TRUE(first.valid);
  EXPECT_EQ(first.move.pose, again.move.pose);
  EXPECT_EQ(first.move.pose, other.move.pose);
  EXPECT_EQ(first.move.duration_ns, other.move.duration_ns);
}

TEST(OdeRollout, TunnelledRolloutIsAFailureNotAResult) {
  const Task task = slab(0.5);
  sim::OdeRollout rollout(task);
  Particle inside;
  inside.pose.position_m.z() = -0.02;
  MoveParameters move;
  move.compliance = task.compliance;
  move.displacement[0] = 0.01;
  const auto result = rollout.simulate(inside, move, 2000, nullptr);
  EXPECT_FALSE(result.valid);
  EXPECT_EQ(result.failure, "a part has gone through another");
  EXPECT_TRUE(rollout.in_collision(inside.pose));
}

}  // namespace
}  // namespace tenon
