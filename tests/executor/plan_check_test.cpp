// Refusals of plans that a cell cannot execute, with their numbers.

#include "executor/plan_check.h"

#include <gtest/gtest.h>

#include "tests/executor/hand_made.h"

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

TEST(PlanCheck, AGantryCannotYieldInRotation) {
  Plan plan = touch_and_slide_plan();
  plan.compliance.compliant_axes = 0x27;
  EXPECT_EQ(refusal(plan, hand_made_cell()),
            "compliant axes x y z rz: the robot can move the tool along x y z only");
}

TEST(PlanCheck, ATurnedStartIsRefusedOnAGantry) {
  Plan plan = touch_and_slide_plan();
  plan.start.orientation = rotation_of(Vector3(0, 0, 0.2));
  EXPECT_EQ(
      refusal(plan, hand_made_cell()),
      "start 's1': the robot's tool is turned by 0.2 rad against it, and the robot moves only x "
      "y z");
}

TEST(PlanCheck, ASlowJointIsRefusedByName) {
  Cell cell = hand_made_cell();
  cell.robot.joints[1].speed_max = 0.08;
  EXPECT_EQ(refusal(touch_and_slide_plan(), cell),
            "start: 0.1 m/s of the tool can ask joint y for 0.1 m/s, its speed_max is 0.08");
}

TEST(PlanCheck, AStartBeyondAJointIsRefusedByThatJoint) {
  Plan plan = touch_and_slide_plan();
  plan.start.position_m.z() = 0.9;  // flange and base are 0.22 m below each other
  const std::string line = refusal(plan, hand_made_cell());
  EXPECT_EQ(line,
            "start 's1': joint z would be at 0.9200 m, must be in [-0.5, 0.5] less 0.005 margin");
}

// start 0 -> +z at most 0.3 -> +z at most 0.3: the second step leaves the range of joint z
TEST(PlanCheck, AStepWhoseEnvelopeLeavesTheRangeIsRefusedByItsNumber) {
  Plan plan = hand_made_plan();
  plan.steps.push_back(hand_made_step(2, 0.3, {{Outcome::kReached, Successor{1}}}));
  plan.steps.push_back(hand_made_step(2, 0.3, {{Outcome::kReached, kSuccessorDone}}));
  const std::string line = refusal(plan, hand_made_cell());
  EXPECT_EQ(line.rfind("step 1: joint z would be at 0.6", 0), 0U) << line;
  plan.steps[1].displacement[2] = -0.3;
  plan.steps[1].outcomes[0].envelope.travelled_min[2] = -0.302;
  plan.steps[1].outcomes[0].envelope.travelled_max[2] = 0.0;
  EXPECT_TRUE(check_plan(plan, hand_made_cell()).empty());
}

}  // namespace
}  // namespace tenon::executor
