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
      "latency (n + m/2) T + tau_arm = (1 + 0.5) * 0.002 + 0 = 0.003 s, the plan allows at most "
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
  plan.parameter_sets[0].speeds.contact_mps = 0.1;
  plan.parameter_sets[0].speeds.approach_mps = 0.2;
  // 6 + 5e4 * 0.1 * (0.012 + 0 + 0.002) = 76 N, of which 40 N are a late wake-up's
  EXPECT_EQ(refusal(plan, hand_made_cell()),
            "parameter set 0: peak force F_on + k_e v ((2 n + m + 3) T + tau_arm + M / D) = 6 + "
            "50000 * 0.1 * (0.012 + 0 + 0.002) = 76 N, must be at most force_fault_N = 60 N");
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

// Its mask lets every contact pass but the one that the step would meet.
TEST(PlanCheck, AMaskThatLeavesNoWayToNoticeAContactIsRefused) {
  Plan plan = touch_and_slide_plan();
  plan.parameter_sets.push_back(plan.parameter_sets[0]);
  plan.steps[1].parameter_set = 1;
  plan.parameter_sets[1].trigger_mask.bits = ContactSignature::bit(1, +1);
  EXPECT_EQ(refusal(plan, hand_made_cell()),
            "step 1 moves along +y, and its trigger mask (+y) lacks -y: a contact there would not "
            "be noticed");
  plan.parameter_sets[1].trigger_mask.bits = ContactSignature::bit(1, -1);
  EXPECT_TRUE(check_plan(plan, hand_made_cell()).empty());
  plan.compliance.compliant_axes = 0x05;
  EXPECT_EQ(refusal(plan, hand_made_cell()),
            "step 1 moves along +y, which does not yield (compliant: x z): a contact there would "
            "not be noticed");
}

TEST(PlanCheck, ATurnIsHeldAgainstTheSameRulesWhereTheCellKnowsWhatItMeets) {
  Plan plan = touch_and_slide_plan();
  plan.compliance.compliant_axes = 0x3F;
  Cell cell = hand_made_cell();
  cell.payload_mass_kg = 0.0;
  EXPECT_TRUE(check_plan(plan, cell).empty());
  cell.contact_stiffness_Nmpr = 1000.0;
  plan.compliance.damping_Nmspr = 4.0;
  plan.compliance.inertia_kgm2 = 0.01;
  plan.parameter_sets[0].speeds.contact_radps = 0.1;
  EXPECT_EQ(
      refusal(plan, cell),
      "rotary damping D = 4 Nm s/rad, must be at least 1.5 k_e tau = 1.5 * 1000 * 0.003 = 4.5 "
      "Nm s/rad");
  plan.compliance.damping_Nmspr = 5.0;
  plan.compliance.inertia_kgm2 = 0.02;
  EXPECT_EQ(refusal(plan, cell),
            "inertia = 0.02 kg m^2, must be at most D tau = 5 * 0.003 = 0.015 kg m^2");
  plan.compliance.inertia_kgm2 = 0.01;
  plan.parameter_sets[0].speeds.contact_radps = 1.0;
  // 0.6 + 1000 * 1 * (0.012 + 0.002)
  EXPECT_EQ(refusal(plan, cell),
            "parameter set 0: peak torque T_on + k_e w ((2 n + m + 3) T + tau_arm + I / D) = 0.6 + "
            "1000 * 1 * 0.014 = 14.6 Nm, must be at most torque_fault_Nm = 10 Nm");
}

TEST(PlanCheck, AnEndThatIsNotAboutTheGoalIsRefused) {
  Plan plan = touch_and_slide_plan();
  plan.goal_tolerance_m = 2e-3;
  plan.goal.position_m = Vector3(0.13, 0.04, 0.0);
  EXPECT_TRUE(check_plan(plan, hand_made_cell()).empty());
  plan.goal.position_m.y() = 0.05;
  EXPECT_EQ(
      refusal(plan, hand_made_cell()),
      "the steps lead to y = [-0.0040, 0.0440] m, the plan's goal is at 0.0500: it was changed "
      "since it was made");
}

}  // namespace
}  // namespace tenon::executor
