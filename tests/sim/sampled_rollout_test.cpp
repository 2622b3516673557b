// Moves on sampled distances: close to those on exact ones, and the same bit for bit whatever an
// instance has done before, also where several threads fill one lattice.

#include <gtest/gtest.h>

#include <cstdio>
#include <thread>
#include <vector>

#include "shared/base/random.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "tests/sim/keyed_peg.h"

namespace tenon::sim {
namespace {

struct DrawnMove {
  Particle from;
  MoveParameters parameters;
};

std::vector<DrawnMove> drawn_moves(std::size_t count) {
  Random random(23);
  const auto drawn = [&](double most) { return most * (2.0 * random.uniform() - 1.0); };
  std::vector<DrawnMove> moves(count);
  for (auto& [from, move] : moves) {
    from.physics.contact_stiffness_Npm = 5e4;
    from.physics.friction = 0.1 + 0.5 * random.uniform();
    from.pose.position_m << drawn(1.5e-3), drawn(1.5e-3), 0.034;
    move.compliance.compliant_axes = 0b000111;
    move.speeds.approach_mps = move.speeds.contact_mps = 0.02;
    move.displacement.head<3>() << drawn(4e-3), drawn(4e-3), -0.01 - 0.02 * random.uniform();
  }
  return moves;
}

std::vector<RolloutResult> run_all(Rollout& rollout, const std::vector<DrawnMove>& moves) {
  std::vector<RolloutResult> results;
  for (const auto& [from, move] : moves) {
    results.push_back(rollout.simulate(from, move, 1000, nullptr));
  }
  return results;
}

int same_ends(const std::vector<RolloutResult>& a, const std::vector<RolloutResult>& b) {
  int same = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    same += a[i].valid == b[i].valid && a[i].move.outcome == b[i].move.outcome &&
            a[i].move.signature == b[i].move.signature && a[i].move.pose == b[i].move.pose;
  }
  return same;
}

TEST(SampledRollout, EndsMostlyWhereTheExactOneDoes) {
  constexpr int kMoves = 60;
  constexpr double kAgreement_m = 0.5e-3;  // as certification asks of half the step
  const Task task = keyed_peg();
  const std::vector<DrawnMove> moves = drawn_moves(kMoves);
  OdeRollout exact_rollout(task);
  OdeRollout sampled_rollout(task, MeshDistances::kSampled);
  const auto exact = run_all(exact_rollout, moves);
  const auto sampled = run_all(sampled_rollout, moves);
  int alike = 0;
  int contacts = 0;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const double off_m = (exact[i].move.pose.position_m - sampled[i].move.pose.position_m).norm();
    alike += exact[i].move.outcome == sampled[i].move.outcome && off_m < kAgreement_m;
    contacts += exact[i].move.outcome == Outcome::kContact;
  }
  std::printf("%d of %d moves end alike, %d of them in contact\n", alike, kMoves, contacts);
  EXPECT_GE(alike, 48);
  EXPECT_GT(contacts, 15);
  EXPECT_LT(same_ends(exact, sampled), kMoves);  // they are two models
}

TEST(SampledRollout, IsTheSameWhateverCameBefore) {
  const Task task = keyed_peg();
  const std::vector<DrawnMove> moves = drawn_moves(30);
  OdeRollout once(task, MeshDistances::kSampled);
  const auto first = run_all(once, moves);
  const std::vector<DrawnMove> backwards(moves.rbegin(), moves.rend());
  const auto again = run_all(once, backwards);
  EXPECT_EQ(same_ends(first, {again.rbegin(), again.rend()}), 30);
}

TEST(SampledRollout, IsTheSameOnThreadsThatFillOneLattice) {
  const std::vector<DrawnMove> moves = drawn_moves(30);
  OdeRollout alone(keyed_peg(), MeshDistances::kSampled);
  const auto expected = run_all(alone, moves);
  const Task shared = keyed_peg();
  std::vector<std::vector<RolloutResult>> results(3);
  std::vector<std::thread> threads;
  for (std::vector<RolloutResult>& result : results) {
    threads.emplace_back([&] {
      OdeRollout rollout(shared, MeshDistances::kSampled);
      result = run_all(rollout, moves);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& result : results) EXPECT_EQ(same_ends(expected, result), 30);
}

}  // namespace
}  // namespace tenon::sim
