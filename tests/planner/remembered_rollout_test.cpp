// What is simulated once is known, to the last bit, and nothing else is taken for it.

#include "planner/belief/remembered_rollout.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <vector>

#include "planner/belief/rollout_pool.h"

namespace tenon::planner {
namespace {

/// Says of a move that it went where it was to go, and counts how often it is asked.
class AskedRollout final : public Rollout {
 public:
  explicit AskedRollout(std::atomic<int>& asked) : asked_(asked) {}

  [[nodiscard]] RolloutResult simulate(const Particle& particle, const MoveParameters& move,
                                       std::int64_t step_us,
                                       std::vector<TraceSample>* trace) override {
    ++asked_;
    if (trace != nullptr) trace->emplace_back();
    RolloutResult result;
    result.valid = true;
    result.move.pose = displaced(particle.pose, move.displacement);
    result.move.duration_ns = 1000 * step_us;
    result.touching = {"a-b"};
    return result;
  }
  [[nodiscard]] bool in_collision(const Pose& tool_pose) override {
    return tool_pose.position_m.x() > 1.0;
  }
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override {
    return std::make_unique<AskedRollout>(asked_);
  }

 private:
  std::atomic<int>& asked_;
};

struct RememberedRolloutTest : ::testing::Test {
  std::atomic<int> asked{0};
  RememberedRollout rollout{AskedRollout(asked)};
  Particle particle;
  MoveParameters move;
};

TEST_F(RememberedRolloutTest, TheSameMoveIsSimulatedOnceWhoeverOfTheClonesIsAsked) {
  move.displacement.x() = 0.1;
  const RolloutResult first = rollout.simulate(particle, move, 2000);
  const RolloutResult again = rollout.clone()->clone()->simulate(particle, move, 2000);
  EXPECT_EQ(asked, 1);
  EXPECT_TRUE(again.valid);
  EXPECT_EQ(again.move.pose, first.move.pose);
  EXPECT_EQ(again.move.duration_ns, 2'000'000);
  EXPECT_EQ(again.touching, first.touching);
}

TEST_F(RememberedRolloutTest, WhateverDiffersIsAnotherMove) {
  (void)rollout.simulate(particle, move, 2000);
  int others = 1;
  const auto is_another = [&](const Particle& p, const MoveParameters& m, std::int64_t step_us) {
    (void)rollout.simulate(p, m, step_us);
    EXPECT_EQ(asked, ++others);
  };
  is_another(particle, move, 1000);
  const auto with = [&](auto change) {
    Particle p = particle;
    MoveParameters m = move;
    change(p, m);
    is_another(p, m, 2000);
  };
  for (int axis = 0; axis < 6; ++axis) {
    with([&](Particle&, MoveParameters& m) { m.displacement[axis] = 1e-9; });
  }
  for (int axis = 0; axis < 3; ++axis) {
    with([&](Particle& p, MoveParameters&) { p.pose.position_m[axis] = 1e-9; });
    with([&](Particle& p, MoveParameters&) { p.environment.position_m[axis] = 1e-9; });
    const Vector3 turn_rad = 1e-6 * Vector3::Unit(axis);
    with([&](Particle& p, MoveParameters&) { p.pose.orientation = rotation_of(turn_rad); });
    with([&](Particle& p, MoveParameters&) { p.environment.orientation = rotation_of(turn_rad); });
  }
  with([](Particle& p, MoveParameters&) { p.signature = ContactSignature{1}; });
  with([](Particle& p, MoveParameters&) { p.physics.friction = 0.31; });
  with([](Particle& p, MoveParameters&) { p.physics.contact_stiffness_Npm = 4e4; });
  with([](Particle& p, MoveParameters&) { p.physics.oversize_m = 1e-4; });
  with([](Particle& p, MoveParameters&) { p.physics.latency_s = 1e-3; });
  with([](Particle&, MoveParameters& m) { m.slow_from_m = 0.1; });
  with([](Particle&, MoveParameters& m) { m.speeds.contact_mps = 0.04; });
  with([](Particle&, MoveParameters& m) { m.thresholds.force_on_N = 7.0; });
  with([](Particle&, MoveParameters& m) { m.compliance.mass_kg = 3.0; });
  with([](Particle&, MoveParameters& m) { m.force_limit_N = 21.0; });
  with([](Particle&, MoveParameters& m) { m.torque_limit_Nm = 1.0; });
  with([](Particle&, MoveParameters& m) { m.timeout_us = 1; });
  with([](Particle&, MoveParameters& m) { m.trigger_mask = ContactSignature{1}; });
  with([](Particle&, MoveParameters& m) { m.sensed_axes = 1; });
  with([](Particle&, MoveParameters& m) { m.aligns = false; });
  with([](Particle&, MoveParameters& m) { m.carried_from = Eigen::Quaterniond::Identity(); });
}

TEST_F(RememberedRolloutTest, ATraceIsTakenOfTheMoveItself) {
  (void)rollout.simulate(particle, move, 2000);
  std::vector<TraceSample> trace;
  (void)rollout.simulate(particle, move, 2000, &trace);
  EXPECT_EQ(asked, 2);
  EXPECT_EQ(trace.size(), 1U);
}

TEST_F(RememberedRolloutTest, CollisionsAreAskedAndThreadsMayShare) {
  Pose beyond;
  beyond.position_m.x() = 2.0;
  EXPECT_TRUE(rollout.in_collision(beyond));
  EXPECT_FALSE(rollout.in_collision({}));
  RolloutPool pool(rollout, 4);
  std::vector<double> ends_m(400);
  const auto run = [&] {
    pool.run(ends_m.size(), [&](Rollout& one, std::size_t i) {
      MoveParameters other;
      other.displacement.x() = static_cast<double>(i % 100);
      ends_m[i] = one.simulate({}, other, 2000).move.pose.position_m.x();
    });
    for (std::size_t i = 0; i < ends_m.size(); ++i) {
      EXPECT_EQ(ends_m[i], static_cast<double>(i % 100));
    }
  };
  run();
  const int first = asked;
  EXPECT_GE(first, 100);
  run();
  EXPECT_EQ(asked, first);
}

// A long judgement asks for more than memory takes; what it has just asked for it asks for again.
TEST_F(RememberedRolloutTest, WhatWasAskedForLastIsKnownHoweverMuchCameBefore) {
  constexpr int kMoves = 260'000;
  constexpr int kAgain = 50'000;
  for (int i = 0; i < kMoves; ++i) {
    move.displacement.x() = 1e-9 * i;
    (void)rollout.simulate(particle, move, 2000);
  }
  EXPECT_EQ(asked, kMoves);
  for (int i = kMoves - kAgain; i < kMoves; ++i) {
    move.displacement.x() = 1e-9 * i;
    (void)rollout.simulate(particle, move, 2000);
  }
  EXPECT_EQ(asked, kMoves);
}

}  // namespace
}  // namespace tenon::planner
