// The discretised compliance law against its closed-form solution.

#include "shared/motion/admittance.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tenon {
namespace {

Compliance compliance(double mass_kg, double damping_Nspm, double stiffness_Npm) {
  Compliance c;
  c.mass_kg = mass_kg;
  c.damping_Nspm = damping_Nspm;
  c.stiffness_Npm = stiffness_Npm;
  c.compliant_axes = 0x3F;
  return c;
}

constexpr double kCycle_s = 2e-3;

Setpoint resting() { return {}; }

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
    Admittance admittance(c);
    double error_m = 0.0;
    for (int i = 1; i * cycle_s <= 1.0; ++i) {
      const double x_m = admittance.update(resting(), wrench, cycle_s).pose.position_m.x();
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
  Admittance admittance(compliance(2.0, 1500.0, 1000.0));
  Vector6 wrench;
  wrench << 3.0, -2.0, 1.0, 0.2, 0.0, 0.0;
  for (int i = 0; i < 20'000; ++i) (void)admittance.update(resting(), wrench, kCycle_s);
  EXPECT_NEAR(admittance.state().pose.position_m.x(), 3e-3, 1e-9);
  EXPECT_NEAR(admittance.state().pose.position_m.y(), -2e-3, 1e-9);
  EXPECT_NEAR(rotation_vector(admittance.state().pose.orientation).x(), 0.2 / 20.0, 1e-9);
  EXPECT_LT(admittance.state().velocity.norm(), 1e-9);
}

TEST(Admittance, AFreeToolIsAtTheSetpointAfterEveryStepOfAMovementGivenByItsMeans) {
  Admittance admittance(compliance(2.0, 1500.0, 1000.0));
  Setpoint setpoint;
  for (int i = 1; i <= 500; ++i) {
    const double x_m = 0.02 * std::sin(10.0 * kCycle_s * i);
    const double velocity_mps = (x_m - setpoint.pose.position_m.x()) / kCycle_s;
    setpoint.acceleration[0] = (velocity_mps - setpoint.velocity[0]) / kCycle_s;
    setpoint.velocity[0] = velocity_mps;
    setpoint.pose.position_m.x() = x_m;
    (void)admittance.update(setpoint, Vector6::Zero(), kCycle_s);
    ASSERT_NEAR(admittance.state().pose.position_m.x(), x_m, 1e-12) << i;
  }
}

TEST(Admittance, AToolLetGoInMotionRunsOutWhereItSays) {
  // With hardly any spring the way of exp(-D t / M) is M / D times the speed.
  Admittance admittance(compliance(2.0, 1500.0, 1e-6));
  Vector6 velocity = Vector6::Zero();
  velocity[0] = 0.1;
  admittance.reset({Pose{}, velocity});
  EXPECT_NEAR(admittance.run_out().position_m.x(), 0.1 * 2.0 / 1500.0, 1e-15);
  for (int i = 0; i < 100; ++i) (void)admittance.update(resting(), Vector6::Zero(), kCycle_s);
  EXPECT_NEAR(admittance.state().pose.position_m.x(), 0.1 * 2.0 / 1500.0, 1e-9);
}

TEST(Admittance, ItIsStableWhereAnExplicitSpringExplodes) {
  constexpr double kLong_s = 10e-3;  // omega T = 316
  Admittance admittance(compliance(1e-3, 0.0, 1e6));
  Vector6 wrench = Vector6::Zero();
  wrench[2] = 100.0;
  double largest_m = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double z_m = admittance.update(resting(), wrench, kLong_s).pose.position_m.z();
    largest_m = std::max(largest_m, std::abs(z_m));
  }
  EXPECT_LT(largest_m, 2.0 * 100.0 / 1e6);
}

TEST(Admittance, AnAxisThatDoesNotYieldIgnoresTheForceAndIsTheSetpoint) {
  Compliance c = compliance(2.0, 1500.0, 1000.0);
  c.compliant_axes = 0x01;
  Admittance admittance(c);
  Setpoint setpoint;
  setpoint.pose.position_m = Vector3(0.0, 0.01, -0.02);
  setpoint.pose.orientation = rotation_of(Vector3(0.0, 0.0, 0.1));
  Vector6 wrench;
  wrench << 1.0, 50.0, -50.0, 5.0, 5.0, 5.0;
  const Admittance::State& state = admittance.update(setpoint, wrench, kCycle_s);
  EXPECT_GT(state.pose.position_m.x(), 0.0);
  EXPECT_NEAR(state.pose.position_m.y(), 0.01, 1e-15);
  EXPECT_NEAR(state.pose.position_m.z(), -0.02, 1e-15);
  EXPECT_NEAR(rotation_vector(state.pose.orientation).z(), 0.1, 1e-12);
}

}  // namespace
}  // namespace tenon
