// Measures the guarded move against ODE over random moves of a box among walls and in corners, with
// the geometry as the judge: what the detector says is compared with the gaps between flat faces.
// Some moves in every run of the tests, sanitized ones too; thousands where a release needs them
// (label full).

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <span>

#include "shared/motion/guarded_move.h"
#include "shared/motion/rules.h"
#include "shared/ports/rollout.h"
#include "shared/task/task.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "sim/physics/solver/ode_world.h"

namespace tenon {
namespace {

constexpr double kBox_m = 0.10;
constexpr double kHalfRoom_m =
    0.25;  // walls stand at +- this in x and y; floor and ceiling at z = 0 and 0.4
constexpr double kCeiling_m = 0.4;

Shape box(const char* name, const Vector3& size_m, const Vector3& centre_m) {
  return {name, Shape::Kind::kBox, size_m, {centre_m, Eigen::Quaterniond::Identity()}};
}

Task room() {
  Task task;
  task.held = {box("box", Vector3::Constant(kBox_m), {0.0, 0.0, 0.5 * kBox_m})};
  const double w = 0.05;
  const double length = 2.0 * (kHalfRoom_m + w);
  const double at = kHalfRoom_m + 0.5 * w;
  task.environment = {box("table", {length, length, w}, {0.0, 0.0, -0.5 * w}),
                      box("ceiling", {length, length, w}, {0.0, 0.0, kCeiling_m + 0.5 * w}),
                      box("wall +x", {w, length, 0.6}, {at, 0.0, 0.2}),
                      box("wall -x", {w, length, 0.6}, {-at, 0.0, 0.2}),
                      box("wall +y", {length, w, 0.6}, {0.0, at, 0.2}),
                      box("wall -y", {length, w, 0.6}, {0.0, -at, 0.2})};
  task.compliance.compliant_axes = 0x07;
  return task;
}

// Gap in front of the face that a push of the given sign on the axis comes from, m; negative:
// overlap.
double gap_m(const Pose& pose, int axis, int push) {
  const double reach_m = kHalfRoom_m - 0.5 * kBox_m;
  if (axis == 2) {
    return push > 0 ? pose.position_m.z() : kCeiling_m - kBox_m - pose.position_m.z();
  }
  return push > 0 ? pose.position_m[axis] + reach_m : reach_m - pose.position_m[axis];
}

struct Tally {
  int moves = 0;
  int invalid = 0;
  int false_contact = 0;
  int missed = 0;
  int false_release = 0;
  int kept = 0;
  int timeout = 0;
  int blocked = 0;
  std::array<int, 5> outcomes{};
  double depth_max_m = 0.0;
  double rest_depth_sum_m = 0.0;
  int rest_depths = 0;
  double peak_force_max_N = 0.0;
};

void judge(const Particle& before, const MoveParameters& move, const GuardedMove::Result& result,
           Tally& tally) {
  constexpr double kTouch_m = 20e-6;
  ++tally.outcomes[static_cast<std::size_t>(result.outcome)];
  tally.peak_force_max_N = std::max(tally.peak_force_max_N, result.peak_force_N);
  for (int axis = 0; axis < 3; ++axis) {
    for (const int push : {+1, -1}) {
      const double gap = gap_m(result.pose, axis, push);
      const bool had = before.signature.has(axis, push);
      const bool has = result.signature.has(axis, push);
      const bool leaving = had && push * move.displacement[axis] > 0.0;
      if (has && !had && gap > kTouch_m) ++tally.false_contact;
      if (had && !has && !leaving) ++tally.false_release;
      if (has && leaving && gap > kTouch_m) ++tally.kept;
      // By its depth the wall presses harder than the on-force, and no bit.
      const double pressed_N = -gap * before.physics.contact_stiffness_Npm;
      if (!had && !has && pressed_N > 1.05 * move.thresholds.force_on_N) ++tally.missed;
      if (has) {
        tally.depth_max_m = std::max(tally.depth_max_m, -gap);
        tally.rest_depth_sum_m += std::max(0.0, -gap);
        ++tally.rest_depths;
      }
    }
  }
}

struct Conditions {
  double stiffness_Npm;
  double damping_Nspm;
  double contact_stiffness_Npm;
  std::int64_t step_us;
  double friction_max = 0.6;
  double force_on_N = 6.0;
  double slowest_mps = 0.05;
  double fastest_mps = 0.25;
  std::uint32_t debounce_us = 6000;
};

Tally study(const Conditions& conditions, int moves, std::uint64_t seed, bool three_d) {
  const Task task = room();
  sim::OdeRollout rollout(task);
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
  };
  Tally tally;
  Particle particle;
  const auto restart = [&] {
    particle = {};
    particle.pose.position_m = {uniform(-0.15, 0.15), uniform(-0.15, 0.15), uniform(0.01, 0.1)};
  };
  restart();
  for (int i = 0; i < moves; ++i) {
    if (i % 40 == 0) restart();
    particle.physics = {uniform(0.0, conditions.friction_max), conditions.contact_stiffness_Npm};
    MoveParameters move;
    move.compliance = task.compliance;
    move.compliance.stiffness_Npm = conditions.stiffness_Npm;
    move.compliance.damping_Nspm = conditions.damping_Nspm;
    move.thresholds.force_on_N = conditions.force_on_N;
    move.thresholds.debounce_us = conditions.debounce_us;
    move.timeout_us = 120'000'000;
    move.speeds.contact_mps = uniform(conditions.slowest_mps, conditions.fastest_mps);
    move.speeds.approach_mps = move.speeds.contact_mps;
    const int axis = static_cast<int>(random() % (three_d ? 3U : 2U));
    move.displacement[axis] = (random() & 1U ? 1.0 : -1.0) * uniform(0.02, 0.25);
    if (random() % 4 == 0) move.displacement[(axis + 1) % 2] += uniform(-0.1, 0.1);
    const RolloutResult result = rollout.simulate(particle, move, conditions.step_us, nullptr);
    ++tally.moves;
    if (!result.valid) {
      ++tally.invalid;
      restart();
      continue;
    }
    judge(particle, move, result.move, tally);
    particle.pose = result.move.pose;
    particle.signature = result.move.signature;
  }
  return tally;
}

void print(const char* name, const Tally& t) {
  std::printf(
      "%-34s %5d moves | false contact %d  missed %d  false release %d  kept by friction %d  "
      "solver or tunnelling %d | reached %d contact %d release %d blocked %d timeout %d | rest "
      "depth "
      "mean %.1f max %.1f um | peak %.0f N\n",
      name, t.moves, t.false_contact, t.missed, t.false_release, t.kept, t.invalid, t.outcomes[0],
      t.outcomes[1], t.outcomes[2], t.outcomes[3], t.outcomes[4],
      1e6 * t.rest_depth_sum_m / std::max(1, t.rest_depths), 1e6 * t.depth_max_m,
      t.peak_force_max_N);
}

struct Row {
  const char* name;
  Conditions conditions;
  bool three_d;
};

void expect_judged_right(std::span<const Row> rows, int moves) {
  Tally all;
  std::uint64_t seed = 1;
  for (const Row& row : rows) {
    ContactThresholds thresholds;
    thresholds.force_on_N = row.conditions.force_on_N;
    EXPECT_EQ(broken_rule(thresholds, 20.0, 1.0, {row.conditions.friction_max, 2, 0.0, 0.0}),
              std::nullopt);
    const Tally t = study(row.conditions, moves, seed++, row.three_d);
    print(row.name, t);
    all.moves += t.moves;
    all.invalid += t.invalid;
    all.false_contact += t.false_contact;
    all.missed += t.missed;
    all.false_release += t.false_release;
    all.kept += t.kept;
    all.timeout += t.outcomes[4];
  }
  EXPECT_EQ(all.moves, static_cast<int>(rows.size()) * moves);
  EXPECT_EQ(all.invalid, 0);
  EXPECT_EQ(all.false_contact, 0);
  EXPECT_EQ(all.missed, 0);
  EXPECT_EQ(all.false_release, 0);
  EXPECT_EQ(all.timeout, 0);
}

constexpr std::array<Row, 8> kRows = {{
    {"K 1000 D 1500 k_e 5e4, 2 ms, 2D", {1000, 1500, 5e4, 2000}, false},
    {"K 1000 D 1500 k_e 5e4, 1 ms, 2D", {1000, 1500, 5e4, 1000}, false},
    {"K 1000 D 1500 k_e 5e4, 2 ms, 3D", {1000, 1500, 5e4, 2000}, true},
    {"K  500 D 1500 k_e 5e4, 2 ms, 3D", {500, 1500, 5e4, 2000}, true},
    {"K 5000 D 1500 k_e 5e4, 2 ms, 3D", {5000, 1500, 5e4, 2000}, true},
    {"the same, friction to 0.8, on 9 N", {5000, 1500, 5e4, 2000, 0.8, 9.0}, true},
    {"K 1000 D 3000 k_e 1e6, 2 ms, 3D", {1000, 3000, 1e6, 2000}, true},
    {"K 1000 D 1500 k_e 5e3, 1 ms, 3D", {1000, 1500, 5e3, 1000}, true},
}};

// As a cell with this cycle gets its plans: damped and slow enough for its latency, the debounce
// two cycles long. The move is stepped once a cycle, as the executor steps it.
constexpr std::array<Row, 3> kSlowRows = {{
    {"K 1000 D 2900 k_e 5e4, 10 ms, 3D",
     {1000, 2900, 5e4, 10'000, 0.6, 6.0, 0.005, 0.03, 20'000},
     true},
    {"K 1000 D 5800 k_e 1e5, 10 ms, 3D",
     {1000, 5800, 1e5, 10'000, 0.6, 6.0, 0.003, 0.015, 20'000},
     true},
    {"K 1000 D 1500 k_e 5e3, 10 ms, 3D",
     {1000, 1500, 5e3, 10'000, 0.6, 6.0, 0.01, 0.05, 20'000},
     true},
}};

TEST(GuardedMoveStudy, RandomMovesOfABoxAmongWallsAreJudgedRightByTheWrench) {
  expect_judged_right(kRows, 700);
}

TEST(GuardedMoveStudy, ACycleOfTenMillisecondsJudgesGentleAndStiffContactsAsWell) {
  expect_judged_right(kSlowRows, 300);
}

TEST(ShortGuardedMoveStudy, RandomMovesOfABoxAmongWallsAreJudgedRightByTheWrench) {
  expect_judged_right(kRows, 40);
}

TEST(ShortGuardedMoveStudy, ACycleOfTenMillisecondsJudgesGentleAndStiffContactsAsWell) {
  expect_judged_right(kSlowRows, 25);
}

}  // namespace
}  // namespace tenon
