// Refusals of plans that a cell cannot execute, with their numbers.

#include "executor/dry_run/plan_check.h"

#include <gtest/gtest.h>

#include "tests/support/hand_made.h"

namespace tenon::executor {
namespace {

// The only refusal of a plan and a cell.
std::string refusal(const Plan& plan, const Cell& cell) {
  const std::vector<std::string> refusals = check_plan(plan, cell);
  EXPECT_EQ(refusals.size(), 1U);
  return refusals.empty() ? "" : refusals.front();
}

TEST(PlanCheck, TheHandMadePlanFitsTheHandMadeCell) {
  for (const std::string& line : check_plan(touch_and_slide_plan(), hand_made_cell())) {
    ADD_FAILURE() << line;
  }
}

TEST(PlanCheck, TheLatencyIsRefusedWithBothNumbers) {
  Plan plan = touch_and_slide_plan();
  plan.latency_max_s = 0.002;
  EXPECT_EQ(
      refusal(plan, hand_made_cell()),
      "latency (n + 1/2) T + tau_arm = (1 + 0.5) * 0.002 + 0 = 0.003 s, the plan allows at most "
      "0.002 s");
}

TEST(PlanCheck, TooLittleDampingForTheContactIsRefused) {
  Plan plan = touch_and_slide_plan();
  plan.compliance.damping_Nspm = 200.0;
  plan.compliance.mass_kg = 0.5;
  plan.parameter_sets[0].speeds.contact_mps = 0.01;
  EXPECT_EQ(refusal(plan, hand_made_cell()),
            "damping D = 200 Ns/m, must be at least 1.5 k_e tau = 1.5 * 50000 * 0.003 = 225 Ns/m");
}

TEST(PlanCheck, TooMuchMassForTheDampingIsRefused) {
  Plan plan = touch_and_slide_plan();
  plan.compliance.mass_kg = 6.0;
  plan.parameter_sets[0].speeds.contact_mps = 0.01;
  EXPECT_EQ(refusal(plan, hand_made_cell()),
            "mass M = 6 kg, must be at most D tau = 1500 * 0.003 = 4.5 kg");
}

TEST(PlanCheck, APeakForceAboveTheCellsFaultIsRefused) {
  Plan plan = touch_and_slide_plan();
  plan.compliance.mass_kg = 3.0;
  plan.parameter_sets[0].speeds.contact_mps = 0.2;
  plan.parameter_sets[0].speeds.approach_mps = 0.2;
  // 6 + 5e4 * 0.2 * (0.004 + 0 + 0.002) = 66 N
  EXPECT_EQ(
      refusal(plan, hand_made_cell()),
      "parameter set 0: peak force F_on + k_e v ((n + 1) T + tau_arm + M / D) = 6 + 50000 * 0.2 "
      "* (0.004 + 0 + 0.002) = 66 N, must be at most force_fault_N = 60 N");
}

TEST(PlanCheck, AnOnThresholdInTheSensorsNoiseIsRefused) {
  Cell cell = hand_made_cell();
  cell.robot.sensor.force_noise_N = 1.5;
  EXPECT_EQ(refusal(touch_and_slide_plan(), cell),
            "parameter set 0: force_on = 6 N, must be at least 5 sigma = 5 * 1.5 = 7.5 N");
}

TEST(PlanCheck, AForceLimitAboveTheFaultIsRefused) {
  Cell cell = hand_made_cell();
  cell.force_fault_N = 50.0;
  Plan plan = touch_and_slide_plan();
  plan.force_limit_N = 55.0;
  EXPECT_EQ(refusal(plan, cell),
            "force_limit = 55 N, must be at most the cell's force_fault_N = 50 N");
}

}  // namespace
}  // namespace tenon::executor
