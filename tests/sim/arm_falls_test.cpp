// What nobody holds falls as mechanics says.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/sim/arm_bench.h"
#include "tests/sim/mechanics.h"

namespace tenon::sim {
namespace {

// M_jj q'' = -dV/dq_j, the other joints braked.
TEST(ArmBodyTest, AJointThatNothingHoldsFallsFreely) {
  const Cell cell = six_axis_cell();
  for (const std::size_t joint : {1U, 2U, 4U}) {
    ArmBench bench(cell, kElbow);
    bench.demands[joint].brake = false;
    const double fall_radps2 =
        -gravity_effort(cell, kElbow, joint) /
        mass_matrix(cell, kElbow)(static_cast<int>(joint), static_cast<int>(joint));
    ASSERT_GT(std::abs(fall_radps2), 1.0);
    constexpr double kTime_s = 0.05;
    bench.run(kTime_s);
    const double fallen = bench.arm.joint(joint).position - kElbow[joint];
    EXPECT_NEAR(fallen, 0.5 * fall_radps2 * kTime_s * kTime_s, 0.03 * std::abs(fallen)) << joint;
    for (std::size_t i = 0; i < 6; ++i) {
      if (i == joint) continue;
      EXPECT_NEAR(bench.arm.joint(i).position, kElbow[i], 1e-6) << i;
    }
  }
}

TEST(ArmBodyTest, AnArmWithoutBrakesAndPowerFallsDown) {
  const Cell cell = six_axis_cell();
  ArmBench bench(cell, kElbow);
  bench.release_all();
  const double before_m = bench.arm.tool().position_m.z();
  bench.run(0.5);
  EXPECT_LT(bench.arm.tool().position_m.z(), before_m - 0.2);
}

TEST(ArmBodyTest, AFreeArmNeverGainsEnergy) {
  const Cell cell = six_axis_cell();
  std::mt19937_64 random(5);
  for (int pose = 0; pose < 3; ++pose) {
    ArmBench bench(cell, random_position(cell, random));
    bench.release_all();
    const double start_J = bench.arm.energy_J();
    // All the energy that there is to gain: from the lowest pose to straight up, some 40 J.
    for (int i = 0; i < 4000; ++i) {
      bench.arm.step(bench.demands, kStep_s);
      ASSERT_LT(bench.arm.energy_J(), start_J + 0.02) << "pose " << pose << " step " << i;
    }
    EXPECT_EQ(bench.arm.solver_messages(), 0U);
  }
}

// Small swings about hanging: (K - w^2 M) v = 0, so det(K - w^2 M) = 0. Started in a mode's shape
// it swings in that mode.
TEST(ArmBodyTest, AFreeDoublePendulumSwingsWithThePeriodsOfItsModes) {
  const Cell cell = pendulum({0.35, 0.30}, {2.0, 1.2});
  JointVector hanging{};
  hanging[0] = std::numbers::pi / 2;  // x turned down about y
  constexpr double kSmall = 1e-3;
  Eigen::Matrix2d stiffness;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      stiffness(static_cast<int>(i), static_cast<int>(j)) =
          (gravity_effort(cell, shifted(hanging, j, kSmall), i) -
           gravity_effort(cell, shifted(hanging, j, -kSmall), i)) /
          (2.0 * kSmall);
    }
  }
  const Eigen::Matrix2d mass = mass_matrix(cell, hanging);
  const double a = mass.determinant();
  const double b = stiffness(0, 0) * mass(1, 1) + stiffness(1, 1) * mass(0, 0) -
                   stiffness(0, 1) * mass(1, 0) - stiffness(1, 0) * mass(0, 1);
  const double root = std::sqrt(b * b - 4.0 * a * stiffness.determinant());
  for (const double way : {-1.0, 1.0}) {
    const double squared_radps2 = (b + way * root) / (2.0 * a);
    const Eigen::Matrix2d left = stiffness - squared_radps2 * mass;
    const Eigen::Vector2d shape = 0.01 * Eigen::Vector2d(left(0, 1), -left(0, 0)).normalized();
    JointVector start = hanging;
    start[0] += shape[0];
    start[1] += shape[1];
    ArmBench bench(cell, start);
    bench.release_all();
    std::vector<double> crossings_s;
    double before = shape[0];
    for (int i = 1; i < 20'000 && crossings_s.size() < 11; ++i) {
      bench.arm.step(bench.demands, kStep_s);
      const double now = bench.arm.joint(0).position - hanging[0];
      if (before * now < 0.0) {
        crossings_s.push_back((i - now / (now - before)) * kStep_s);
      }
      before = now;
    }
    ASSERT_EQ(crossings_s.size(), 11U);
    const double period_s = (crossings_s.back() - crossings_s.front()) / 5.0;
    const double expected_s = 2.0 * std::numbers::pi / std::sqrt(squared_radps2);
    EXPECT_NEAR(period_s, expected_s, 1e-3 * expected_s) << way;
  }
}

}  // namespace
}  // namespace tenon::sim
