// Rule 5 of a guarded move, inequality by inequality; and from a result to the next step.

#include "shared/motion/rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "shared/plan/transition.h"
#include "tests/shared/example_plans.h"

namespace tenon {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string broken(const ContactThresholds& thresholds, const ContactConditions& conditions = {},
                   double force_limit_N = 20.0, double acceleration_mps2 = 1.0) {
  return broken_rule(thresholds, force_limit_N, acceleration_mps2, conditions).value_or("holds");
}

TEST(Rules, DefaultsHold) { EXPECT_EQ(broken({}), "holds"); }

TEST(Rules, ThresholdsMustBeOrdered) {
  EXPECT_EQ(broken({.force_on_N = 6.0, .force_keep_N = 6.0}),
            "0 < force_off < force_keep < force_on does not hold: 1.5, 6, 6 N");
  EXPECT_EQ(broken({.force_off_N = 0.0}),
            "0 < force_off < force_keep < force_on does not hold: 0, 3, 6 N");
  EXPECT_EQ(broken({.torque_off_Nm = 0.4}),
            "0 < torque_off < torque_keep < torque_on does not hold: 0.4, 0.3, 0.6 Nm");
}

TEST(Rules, EveryInequalityIsNamedWithItsNumbers) {
  EXPECT_EQ(broken({}, {}, 8.9), "force_on = 6 N must be at most force_limit / 1.5 = 5.93333 N");
  EXPECT_EQ(broken({}, {}, 9.0), "holds");
  // With two contacts the bound is 1.25 mu (2 + mu) keep, which is 6 N at mu = sqrt(2.6) - 1.
  EXPECT_EQ(broken({}, {.friction_max = 0.612, .contacts_max = 2}), "holds");
  EXPECT_THAT(
      broken({}, {.friction_max = 0.613, .contacts_max = 2}),
      AllOf(StartsWith("force_on = 6 N must be at least 1.25 mu "), HasSubstr("= 6.00663 N"),
            HasSubstr("mu = 0.613"), HasSubstr("n = 2"), HasSubstr("force_keep = 3 N")));
  EXPECT_EQ(broken({}, {.mass_uncompensated_kg = 0.5}, 20.0, 7.0),
            "force_on = 6 N must be at least 2 * uncompensated mass * acceleration = 2 * 0.5 * 7 = "
            "7 N");
  EXPECT_EQ(broken({}, {.mass_uncompensated_kg = 0.5}, 20.0, 6.0), "holds");
  EXPECT_EQ(broken({}, {.force_noise_N = 1.3}),
            "force_on = 6 N must be at least 5 * force noise = 5 * 1.3 = 6.5 N");
  EXPECT_EQ(broken({}, {.force_noise_N = 1.2}), "holds");
}

// Step 0 of the documented plan: contact +x after -0.2431 .. -0.0569 m along x, 1.2 mm along y.
GuardedMove::Result first_result() {
  GuardedMove::Result result;
  result.outcome = Outcome::kContact;
  result.signature = {ContactSignature::bit(0, +1)};
  result.travelled[0] = -0.15;
  result.travelled[2] = 5.0;  // not a coordinate of the plan
  return result;
}

TEST(Transition, ExpectedResultGoesToTheSuccessor) {
  const Transition next = transition(tests::documented_plan(), 0, {}, first_result());
  EXPECT_EQ(next.successor, 1);
  EXPECT_EQ(next.deviation, Deviation::kNone);
}

TEST(Transition, EveryDeviationFailsAndIsNamed) {
  const Plan plan = tests::documented_plan();
  GuardedMove::Result result = first_result();
  result.outcome = Outcome::kReached;
  EXPECT_EQ(transition(plan, 0, plan.start, result).deviation, Deviation::kUnexpectedOutcome);

  result = first_result();
  result.travelled[1] = 0.0013;
  EXPECT_EQ(transition(plan, 0, plan.start, result).deviation, Deviation::kTravelOutside);
  EXPECT_EQ(transition(plan, 0, plan.start, result).index, 1);
  EXPECT_EQ(transition(plan, 0, plan.start, result).successor, kSuccessorFail);

  result = first_result();
  result.signature = {};
  EXPECT_EQ(transition(plan, 0, plan.start, result).deviation, Deviation::kContactMissing);
  EXPECT_EQ(transition(plan, 0, plan.start, result).index, 0);

  result = first_result();
  result.signature.bits |= ContactSignature::bit(1, -1);
  EXPECT_EQ(transition(plan, 0, plan.start, result).deviation, Deviation::kContactUnforeseen);
  EXPECT_EQ(transition(plan, 0, plan.start, result).index, 3);
}

TEST(Transition, WhereATurningToolEndsIsHeldAgainstWhereItWasSeen) {
  Plan plan = tests::documented_plan();
  plan.check_places = true;
  Envelope& seen = plan.steps[0].outcomes[static_cast<std::size_t>(Outcome::kContact)].envelope;
  seen.place_min.head<2>() << -0.20, -0.01;
  seen.place_max.head<2>() << -0.10, 0.01;
  const Pose start{{0.3, 0.2, 0.1}, rotation_of({0.0, 0.0, 0.1})};
  GuardedMove::Result result = first_result();
  result.pose = displaced(start, {-0.15, 0.0, 0.0, 0.0, 0.0, 0.0});
  EXPECT_EQ(transition(plan, 0, start, result).deviation, Deviation::kNone);
  result.pose = displaced(start, {-0.15, 0.02, 0.0, 0.0, 0.0, 0.0});
  const Transition beside = transition(plan, 0, start, result);
  EXPECT_EQ(beside.deviation, Deviation::kPlaceOutside);
  EXPECT_EQ(beside.index, 1);
  EXPECT_NEAR(beside.travelled, 0.02, 1e-12);
  EXPECT_EQ(beside.travelled_max, 0.01);
}

TEST(Transition, WithoutEnvelopesTheOutcomeAloneDecides) {
  Plan plan = tests::documented_plan();
  plan.check_envelopes = false;
  GuardedMove::Result result = first_result();
  result.travelled[0] = 3.0;
  result.signature = {};
  EXPECT_EQ(transition(plan, 0, plan.start, result).successor, 1);
  result.outcome = Outcome::kBlocked;
  EXPECT_EQ(transition(plan, 0, plan.start, result).successor, kSuccessorFail);
}

TEST(Transition, NotANumberIsOutside) {
  GuardedMove::Result result = first_result();
  result.travelled[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(transition(tests::documented_plan(), 0, {}, result).deviation,
            Deviation::kTravelOutside);
}

}  // namespace
}  // namespace tenon
