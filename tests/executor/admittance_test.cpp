// The discretised compliance law against its closed-form solution.

#include "executor/admittance.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tenon::executor {
namespace {

Compliance compliance(double mass_kg, double damping_Nspm, double stiffness_Npm) {
  Compliance c;
  c.mass_kg = mass_kg;
  c.damping_Nspm = damping_Nspm;
  c.stiffness_Npm = stiffness_Npm;
  c.compliant_axes = 0x3F;
  return c;
}

GuardedMove::Setpoint resting() { return {}; }

// x(t) of M x'' + D x' + K x = f from rest at 0, overdamped.
double step_response_m(const Compliance& c, double force_N, double time_s) {
  const double half = 0.5 * c.damping_Nspm / c.mass_kg;
  const double root = std::sqrt(half * half - c.stiffness_Npm / c.mass_kg);
  const double slow = -half + root;
  const double fast = -half - root;
  const double end_m = force_N / c.stiffness_Npm;
  return end_m *
         (1.0 + (fast * std::exp(slow * time_s) - slow * std::exp(fast * time_s)) / (slow - fast));
}

// Backward Euler is of first order: halving the cycle halves the error.
TEST(Admittance, AForceStepApproachesTheClosedFormWithTheFirstOrderOfTheCycle) {
  const Compliance c = compliance(2.0, 1500.0, 1000.0);
  Vector6 wrench = Vector6::Zero();
  wrench[0] = 5.0;
  double last_error_m = 0.0;
  for (const double cycle_s : {2e-3, 1e-3, 5e-4}) {
    Admittance admittance(c, cycle_s);
    double error_m = 0.0;
    for (int i = 1; i * cycle_s <= 1.0; ++i) {
      const double x_m = admittance.update(resting(), wrench).pose.position_m.x();
      error_m = std::max(error_m, std::abs(x_m - step_response_m(c, 5.0, i * cycle_s)));
    }
    EXPECT_LT(error_m, 2e-5);
    if (last_error_m > 0.0) {
      EXPECT_NEAR(last_error_m / error_m, 2.0, 0.5);
    }
    last_error_m = error_m;
  }
}

TEST(Admittance, RestUnderAForceIsForceOverStiffness) {
  Admittance admittance(compliance(2.0, 1500.0, 1000.0), 2e-3);
  Vector6 wrench;
  wrench << 3.0, -2.0, 1.0, 0.2, 0.0, 0.0;
  for (int i = 0; i < 20'000; ++i) (void)admittance.update(resting(), wrench);
  EXPECT_NEAR(admittance.state().pose.position_m.x(), 3e-3, 1e-9);
  EXPECT_NEAR(admittance.state().pose.position_m.y(), -2e-3, 1e-9);
  EXPECT_NEAR(rotation_vector(admittance.state().pose.orientation).x(), 0.2 / 20.0, 1e-9);
  EXPECT_LT(admittance.state().velocity.norm(), 1e-9);
}

TEST(Admittance, AFreeToolFollowsAMovingSetpointWithoutLag) {
  Admittance admittance(compliance(2.0, 1500.0, 1000.0), 2e-3);
  GuardedMove::Setpoint setpoint;
  for (int i = 1; i <= 500; ++i) {
    const double t_s = 2e-3 * i;
    setpoint.pose.position_m.x() = 0.05 * t_s * t_s;
    setpoint.velocity[0] = 0.1 * t_s;
    setpoint.acceleration[0] = 0.1;
    (void)admittance.update(setpoint, Vector6::Zero());
  }
  EXPECT_NEAR(admittance.state().pose.position_m.x(), 0.05, 2e-4 * 0.1 + 1e-4);
  EXPECT_NEAR(admittance.state().velocity[0], 0.1, 1e-3);
}

TEST(Admittance, ItIsStableWhereAnExplicitSpringExplodes) {
  Admittance admittance(compliance(1e-3, 0.0, 1e6), 10e-3);  // omega T = 316
  Vector6 wrench = Vector6::Zero();
  wrench[2] = 100.0;
  double largest_m = 0.0;
  for (int i = 0; i < 1000; ++i) {
    largest_m =
        std::max(largest_m, std::abs(admittance.update(resting(), wrench).pose.position_m.z()));
  }
  EXPECT_LT(largest_m, 2.0 * 100.0 / 1e6);
}

TEST(Admittance, AnAxisThatDoesNotYieldIgnoresTheForceAndIsTheSetpoint) {
  Compliance c = compliance(2.0, 1500.0, 1000.0);
  c.compliant_axes = 0x01;
  Admittance admittance(c, 2e-3);
  GuardedMove::Setpoint setpoint;
  setpoint.pose.position_m = Vector3(0.0, 0.01, -0.02);
  setpoint.pose.orientation = rotation_of(Vector3(0.0, 0.0, 0.1));
  Vector6 wrench;
  wrench << 1.0, 50.0, -50.0, 5.0, 5.0, 5.0;
  const Admittance::State& state = admittance.update(setpoint, wrench);
  EXPECT_GT(state.pose.position_m.x(), 0.0);
  EXPECT_NEAR(state.pose.position_m.y(), 0.01, 1e-15);
  EXPECT_NEAR(state.pose.position_m.z(), -0.02, 1e-15);
  EXPECT_NEAR(rotation_vector(state.pose.orientation).z(), 0.1, 1e-12);
}

}  // namespace
}  // namespace tenon::executor
