// The inequalities of stiff contact against numbers worked out by hand.

#include "shared/motion/stiff_contact.h"

#include <gtest/gtest.h>

namespace tenon {
namespace {

// tau = 1.5 * 10 ms + 20 ms = 35 ms.
constexpr ContactLoop kSlow{5e4, 0.010, 1, 0.020};

TEST(StiffContact, DampingAndMassFollowFromStiffnessAndLatency) {
  EXPECT_DOUBLE_EQ(kSlow.latency_s(), 0.035);
  EXPECT_DOUBLE_EQ(damping_least_Nspm(kSlow), 2625.0);
  EXPECT_DOUBLE_EQ(mass_most_kg(kSlow, 2000.0), 70.0);
}

TEST(StiffContact, ThePeakIsTheThresholdAndTheWayUntilTheToolStops) {
  Compliance compliance;
  compliance.mass_kg = 10.0;
  compliance.damping_Nspm = 2500.0;
  // 6 + 5e4 * 0.01 * (20 + 40 + 20 + 4 ms): the sample, a late wake-up, the arm, the law.
  EXPECT_DOUBLE_EQ(peak_force_N(kSlow, compliance, 6.0, 0.01), 48.0);
}

TEST(StiffContact, AGentleTouchIsPressedByTheProbeAllTheSame) {
  constexpr ContactLoop kSoft{5e3, 0.002, 1, 0.004};
  EXPECT_DOUBLE_EQ(peak_force_N(kSoft, {}, 6.0, 1e-3), 9.0);
}

TEST(StiffContact, ACellGivesItsOwnNumbers) {
  Cell cell;
  cell.contact_stiffness_Npm = 3e4;
  cell.robot.cycle_us = 5000;
  cell.robot.measurement_delay_cycles = 2;
  cell.robot.response_lag_s = 0.012;
  const ContactLoop loop = contact_loop(cell);
  EXPECT_DOUBLE_EQ(loop.stiffness_Npm, 3e4);
  EXPECT_DOUBLE_EQ(loop.latency_s(), 2.5 * 0.005 + 0.012);
  EXPECT_DOUBLE_EQ(loop.blind_s(), (3 + 5) * 0.005 + 0.012);
  EXPECT_DOUBLE_EQ(loop.latency_s(), latency_s(cell.robot));
}

//  cycle   |   |   |   |   |   |      T = 2 ms
//  sample  x       :       x          m = 3: held for 6 ms, on average half of that old
TEST(StiffContact, ASensorSlowerThanTheCycleIsBlindForItsOwnPeriod) {
  Cell cell;
  cell.contact_stiffness_Npm = 5e4;
  cell.robot.cycle_us = 2000;
  cell.robot.measurement_delay_cycles = 1;
  cell.robot.response_lag_s = 0.004;
  cell.robot.sensor.cycles_per_sample = 3;
  const ContactLoop loop = contact_loop(cell);
  // 2 + 3 + 4 ms, against 2 + 1 + 4 ms with a sample in every cycle
  EXPECT_NEAR(loop.latency_s(), 0.009, 1e-12);
  EXPECT_NEAR(damping_least_Nspm(loop), 675.0, 1e-9);
  // 2 + 6 + 8 + 4 ms: n T, m T, a late wake-up's (n + 3) T, the arm
  EXPECT_NEAR(loop.blind_s(), 0.020, 1e-12);
  Compliance compliance;
  compliance.mass_kg = 3.0;
  compliance.damping_Nspm = 1500.0;
  EXPECT_NEAR(peak_force_N(loop, compliance, 6.0, 0.02), 28.0, 1e-9);
  EXPECT_DOUBLE_EQ(sample_period_s(cell.robot), 0.006);
  EXPECT_DOUBLE_EQ(latency_s(cell.robot), loop.latency_s());
}

}  // namespace
}  // namespace tenon
