// A move from a restored particle is the move of an uninterrupted run, bit for bit: in any world,
// after anything else, on any thread.

#include <gtest/gtest.h>

#include <bit>
#include <random>
#include <thread>
#include <vector>

#include "shared/task/ring.h"
#include "sim/physics/rollout/ode_rollout.h"

namespace tenon::sim {
namespace {

Task round_peg() {
  Task task;
  task.held = {
      {"peg", Shape::Kind::kCylinder, {0.04, 0.04, 0.1}, {{0.0, 0.0, 0.05}, {1, 0, 0, 0}}}};
  Ring ring;
  ring.name = "hole";
  ring.inner_diameter_m = 0.042;
  ring.outer_diameter_m = 0.2;
  ring.length_m = 0.05;
  ring.pose.position_m.z() = -0.025;
  task.environment = boxes_of(ring);
  return task;  // all six axes yield
}

struct Move {
  Particle from;
  MoveParameters parameters;
  RolloutResult result;
  std::vector<TraceSample> trace;
};

MoveParameters random_move(std::mt19937_64& random) {
  const auto uniform = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
  };
  MoveParameters move;
  for (int axis = 0; axis < 3; ++axis) move.displacement[axis] = uniform(-0.02, 0.02);
  move.displacement.z() -= 0.02;
  if (random() % 2 == 0) move.displacement[3] = uniform(-0.05, 0.05);
  return move;
}

/// Moves one after the other in one world, each from where the last one ended.
std::vector<Move> uninterrupted(const Task& task, std::uint64_t seed, int count) {
  OdeRollout rollout(task);
  std::mt19937_64 random(seed);
  std::vector<Move> moves;
  Particle particle;
  particle.pose = {{0.003, -0.002, 0.01}, rotation_of({0.01, -0.02, 0.0})};
  for (int i = 0; i < count; ++i) {
    Move move{particle, random_move(random), {}, {}};
    move.result = rollout.simulate(particle, move.parameters, 2000, &move.trace);
    if (move.result.valid) {
      particle.pose = move.result.move.pose;
      particle.signature = move.result.move.signature;
    }
    moves.push_back(move);
  }
  return moves;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same_bits(const Pose& a, const Pose& b) {
  bool same = true;
  for (int i = 0; i < 3; ++i) same = same && same_bits(a.position_m[i], b.position_m[i]);
  for (int i = 0; i < 4; ++i) {
    same = same && same_bits(a.orientation.coeffs()[i], b.orientation.coeffs()[i]);
  }
  return same;
}

/// Whether the move, restored into this world, runs as it did; every sample of it.
bool runs_the_same(OdeRollout& rollout, const Move& move) {
  std::vector<TraceSample> trace;
  const RolloutResult again = rollout.simulate(move.from, move.parameters, 2000, &trace);
  bool same = again.valid == move.result.valid && trace.size() == move.trace.size() &&
              again.move.signature == move.result.move.signature &&
              again.move.outcome == move.result.move.outcome;
  for (std::size_t i = 0; same && i < trace.size(); ++i) {
    const GuardedMove::Input& a = trace[i].input;
    const GuardedMove::Input& b = move.trace[i].input;
    same =
        same_bits(a.pose, b.pose) && same_bits(trace[i].setpoint.pose, move.trace[i].setpoint.pose);
    for (int axis = 0; axis < 6; ++axis) same = same && same_bits(a.wrench[axis], b.wrench[axis]);
  }
  return same;
}

TEST(RolloutRestore, AFreshWorldRepeatsEveryMove) {
  const Task task = round_peg();
  int touching = 0;
  for (const Move& move : uninterrupted(task, 1, 40)) {
    OdeRollout fresh(task);
    EXPECT_TRUE(runs_the_same(fresh, move));
    touching += move.result.move.signature.count() > 0;
  }
  EXPECT_GE(touching, 10);
}

TEST(RolloutRestore, AWorldThatDidOtherThingsRepeatsEveryMove) {
  const Task task = round_peg();
  const std::vector<Move> moves = uninterrupted(task, 2, 40);
  const std::vector<Move> others = uninterrupted(task, 3, 40);
  OdeRollout used(task);
  std::mt19937_64 random(4);
  for (std::size_t i = moves.size(); i-- > 0;) {
    const Move& other = others[random() % others.size()];
    (void)used.simulate(other.from, other.parameters, 1000, nullptr);
    (void)used.in_collision(other.from.pose);
    EXPECT_TRUE(runs_the_same(used, moves[i])) << i;
  }
}

TEST(RolloutRestore, AnOversizedPartIsThatParticlesAlone) {
  // 2 mm of clearance: a peg that is 1 mm oversize goes in, one of 3 mm does not, and neither
  // changes the world for the next.
  OdeRollout rollout(round_peg());
  MoveParameters down;
  down.displacement.z() = -0.03;
  const auto end = [&](double oversize_m) {
    Particle particle;
    particle.pose.position_m.z() = 0.01;
    particle.physics.oversize_m = oversize_m;
    return rollout.simulate(particle, down, 2000, nullptr).move;
  };
  EXPECT_EQ(end(0.0).outcome, Outcome::kReached);
  EXPECT_EQ(end(0.003).outcome, Outcome::kContact);
  EXPECT_GT(end(0.003).pose.position_m.z(), 0.0);
  EXPECT_EQ(end(0.001).outcome, Outcome::kReached);
  EXPECT_EQ(end(0.0).pose.position_m.z(), end(0.001).pose.position_m.z());
  Task larger = round_peg();
  larger.oversize_m = 0.003;
  Pose inside;
  inside.position_m.z() = -0.01;
  EXPECT_FALSE(rollout.in_collision(inside));
  EXPECT_TRUE(OdeRollout(larger).in_collision(inside));
}

TEST(RolloutRestore, OtherThreadsRepeatEveryMove) {
  const Task task = round_peg();
  const std::vector<Move> moves = uninterrupted(task, 5, 40);
  std::vector<int> same(4, 0);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < same.size(); ++t) {
    threads.emplace_back([&, t] {
      OdeRollout rollout(task);
      for (std::size_t i = 0; i < moves.size(); ++i) {
        same[t] += runs_the_same(rollout, moves[(i * 7 + t * 11) % moves.size()]);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(same, std::vector<int>(4, static_cast<int>(moves.size())));
}

}  // namespace
}  // namespace tenon::sim
