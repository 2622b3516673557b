// A part that rests at an edge: seen from collisions alone, and no move of the search.

#include "planner/belief/edge_rest.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "planner/belief/successor.h"
#include "sim/physics/rollout/ode_rollout.h"

namespace tenon::planner {
namespace {

constexpr std::uint8_t kTranslations = 0b111;

/// A cube of 40 mm, and a plate whose edge stands at x = 0.
Task part_and_plate() {
  Task task;
  task.compliance.compliant_axes = kTranslations;
  task.held = {{"part", Shape::Kind::kBox, {0.04, 0.04, 0.04}, {{0.0, 0.0, 0.02}, {1, 0, 0, 0}}}};
  task.environment = {
      {"plate", Shape::Kind::kBox, {0.2, 0.2, 0.1}, {{-0.1, 0.0, -0.05}, {1, 0, 0, 0}}}};
  return task;
}

/// So far over the plate from its edge inwards.
Particle over(double overlap_m, double z_m) {
  Particle particle;
  particle.pose.position_m = {0.02 - overlap_m, 0.0, z_m};
  return particle;
}

Particle resting(double overlap_m) {
  Particle particle = over(overlap_m, 0.0);
  particle.signature.bits = ContactSignature::bit(2, +1);
  return particle;
}

TEST(EdgeRest, TellsANarrowRestFromAWideOne) {
  sim::OdeRollout rollout(part_and_plate());
  EXPECT_TRUE(rests_at_edge(resting(0.1e-3), kTranslations, rollout));
  EXPECT_TRUE(rests_at_edge(resting(0.25e-3), kTranslations, rollout));
  EXPECT_FALSE(rests_at_edge(resting(0.6e-3), kTranslations, rollout));
  EXPECT_FALSE(rests_at_edge(resting(60e-3), kTranslations, rollout));
}

/// Against the plate's side, its lower face so far below the plate's upper one.
Particle caught(double depth_m) {
  Particle particle = over(0.0, -depth_m);
  particle.signature.bits = ContactSignature::bit(0, +1);
  return particle;
}

// Of a peg over the mouth of a hole, say, that has sunk in by as much as it was pressed. Such a
// contact, too slight for a collision, was taken for a firm one.
TEST(EdgeRest, TellsASlightCatchFromAFirmOne) {
  sim::OdeRollout rollout(part_and_plate());
  EXPECT_TRUE(rests_at_edge(caught(0.05e-3), kTranslations, rollout));
  EXPECT_TRUE(rests_at_edge(caught(0.25e-3), kTranslations, rollout));
  EXPECT_FALSE(rests_at_edge(caught(0.6e-3), kTranslations, rollout));
  EXPECT_FALSE(rests_at_edge(caught(20e-3), kTranslations, rollout));
}

/// On a plate that slopes up by 80 degrees along x: pressed along z it goes in by little.
TEST(EdgeRest, ASteepFaceIsNoSlightCatch) {
  Task task = part_and_plate();
  task.held = {
      {"block", Shape::Kind::kBox, {0.04, 0.04, 0.04}, {{0, 0, 0}, rotation_of({0, -1.4, 0})}}};
  task.environment = {
      {"slope",
       Shape::Kind::kBox,
       {0.2, 0.2, 0.2},
       {{0.12 * std::sin(1.4), 0.0, -0.12 * std::cos(1.4)}, rotation_of({0, -1.4, 0})}}};
  sim::OdeRollout rollout(task);
  Particle particle;
  particle.signature.bits = ContactSignature::bit(2, +1);
  EXPECT_FALSE(rests_at_edge(particle, 0b100, rollout));
}

TEST(EdgeRest, AsksOnlyAboutAxesThatYield) {
  sim::OdeRollout rollout(part_and_plate());
  EXPECT_FALSE(rests_at_edge(resting(0.1e-3), 0b110, rollout));
  EXPECT_FALSE(rests_at_edge(resting(0.1e-3), 0b011, rollout));
}

TEST(EdgeRest, APartThatTouchesNothingRestsAtNoEdge) {
  sim::OdeRollout rollout(part_and_plate());
  Particle free = resting(0.1e-3);
  free.signature = {};
  EXPECT_FALSE(rests_at_edge(free, kTranslations, rollout));
}

TEST(EdgeRest, AMoveThatLeavesAParticleAtAnEdgeDoesNotExist) {
  const Task task = part_and_plate();
  RolloutPool pool(sim::OdeRollout(task), 1);
  MoveParameters move;
  move.compliance = task.compliance;
  SuccessorEngine engine(pool, move, task.rollout_step_us);
  Primitive down;
  down.displacement.z() = -0.02;
  const auto exists = [&](double overlap_m) {
    return engine.successors({{over(overlap_m, 0.01)}}, std::array{down})[0].has_value();
  };
  EXPECT_TRUE(exists(5e-3));
  EXPECT_FALSE(exists(0.2e-3));
  EXPECT_TRUE(exists(-1e-3)) << "beside the plate nothing holds it";
}

}  // namespace
}  // namespace tenon::planner
