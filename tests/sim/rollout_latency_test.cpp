// What an arm's latency does to a guarded move: the move sees pose and wrench late, the plant does
// not wait.

#include <gtest/gtest.h>

#include "sim/physics/rollout/ode_rollout.h"

namespace tenon::sim {
namespace {

constexpr double kLatency_s = 0.010;

/// A cube of 40 mm over a plate that ends at x = 0, before a wall at x = 0.3.
Task plate_and_wall() {
  Task task;
  task.compliance.compliant_axes = 0b111;
  task.held = {{"part", Shape::Kind::kBox, {0.04, 0.04, 0.04}, {{0.0, 0.0, 0.02}, {1, 0, 0, 0}}}};
  task.environment = {
      {"plate", Shape::Kind::kBox, {0.2, 0.2, 0.1}, {{-0.1, 0.0, -0.05}, {1, 0, 0, 0}}},
      {"wall", Shape::Kind::kBox, {0.1, 0.2, 0.2}, {{0.35, 0.0, 0.1}, {1, 0, 0, 0}}}};
  return task;
}

/// Nothing turns the tool.
MoveParameters straight() {
  MoveParameters move;
  move.compliance.compliant_axes = 0b000111;
  return move;
}

Particle resting_on_the_plate(OdeRollout& rollout, double latency_s) {
  Particle particle;
  particle.pose.position_m = {-0.05, 0.0, 0.01};
  MoveParameters down = straight();
  down.displacement.z() = -0.03;
  const RolloutResult onto = rollout.simulate(particle, down, 2000, nullptr);
  particle.pose = onto.move.pose;
  particle.signature = onto.move.signature;
  particle.physics.latency_s = latency_s;
  return particle;
}

GuardedMove::Result along_x(double latency_s, const Particle& from, OdeRollout& rollout,
                            std::int64_t step_us = 2000) {
  MoveParameters move = straight();
  move.displacement.x() = 0.15;
  Particle particle = from;
  particle.physics.latency_s = latency_s;
  const RolloutResult result = rollout.simulate(particle, move, step_us, nullptr);
  EXPECT_TRUE(result.valid) << result.failure;
  return result.move;
}

// Afterwards the spring draws the tool back to where the move saw it, so slowly that it is at rest
// half way at most.
TEST(RolloutLatency, AnEdgeThatIsNoticedLateIsPassedByThatMuch) {
  OdeRollout rollout(plate_and_wall());
  const Particle start = resting_on_the_plate(rollout, 0.0);
  ASSERT_EQ(start.signature.sign(2), 1);
  const GuardedMove::Result at_once = along_x(0.0, start, rollout);
  const GuardedMove::Result late = along_x(kLatency_s, start, rollout);
  ASSERT_EQ(at_once.outcome, Outcome::kRelease);
  ASSERT_EQ(late.outcome, Outcome::kRelease);
  const double passed_m = kLatency_s * MoveParameters{}.speeds.contact_mps;
  const double farther_m = late.pose.position_m.x() - at_once.pose.position_m.x();
  EXPECT_GT(farther_m, 0.5 * passed_m);
  EXPECT_LT(farther_m, 1.05 * passed_m);
}

TEST(RolloutLatency, AWallThatIsNoticedLateStandsWhereItStood) {
  OdeRollout rollout(plate_and_wall());
  Particle start;
  start.pose.position_m = {0.20, 0.0, 0.05};
  const GuardedMove::Result at_once = along_x(0.0, start, rollout);
  const GuardedMove::Result late = along_x(kLatency_s, start, rollout);
  EXPECT_EQ(late.outcome, Outcome::kContact);
  EXPECT_EQ(late.signature, at_once.signature);
  EXPECT_NEAR(late.pose.position_m.x(), at_once.pose.position_m.x(), 1e-4);
  EXPECT_GT(late.peak_force_N, at_once.peak_force_N);
}

TEST(RolloutLatency, HalfTheIntegrationStepSeesTheSameLatency) {
  OdeRollout rollout(plate_and_wall());
  const Particle start = resting_on_the_plate(rollout, 0.0);
  for (const double latency_s : {0.0, 0.007, kLatency_s}) {
    // The edge is noticed a step earlier or later: 0.1 mm at contact speed, and what that settles.
    EXPECT_NEAR(along_x(latency_s, start, rollout, 1000).pose.position_m.x(),
                along_x(latency_s, start, rollout, 2000).pose.position_m.x(), 1.1e-4)
        << latency_s;
  }
}

TEST(RolloutLatency, TwiceTheIntegrationStepSeesNoLessOfIt) {
  OdeRollout rollout(plate_and_wall());
  const Particle start = resting_on_the_plate(rollout, 0.0);
  const double at_once_m = along_x(0.0, start, rollout, 4000).pose.position_m.x();
  // One step of the task's, and five: an odd number of them.
  for (const double latency_s : {0.002, kLatency_s}) {
    const double passed_m = latency_s * MoveParameters{}.speeds.contact_mps;
    EXPECT_GT(along_x(latency_s, start, rollout, 4000).pose.position_m.x() - at_once_m,
              0.5 * passed_m)
        << latency_s;
  }
}

TEST(RolloutLatency, InFreeAirNothingIsNoticed) {
  OdeRollout rollout(plate_and_wall());
  Particle start;
  start.pose.position_m = {-0.05, 0.0, 0.05};
  const GuardedMove::Result at_once = along_x(0.0, start, rollout);
  const GuardedMove::Result late = along_x(kLatency_s, start, rollout);
  EXPECT_EQ(late.outcome, Outcome::kReached);
  EXPECT_NEAR(late.pose.position_m.x(), at_once.pose.position_m.x(), 2e-5);
}

}  // namespace
}  // namespace tenon::sim
