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

}  // namespace
}  // namespace tenon
