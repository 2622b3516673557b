// The planner's port to an arm's reach says of each step what the dry run says of the plan.

#include "executor/dry_run/cell_reach.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <optional>
#include <string>

#include "executor/dry_run/dry_run.h"
#include "shared/base/random.h"
#include "tests/support/hand_made.h"

namespace tenon::executor {
namespace {

/// A few steps, each anywhere, with an envelope about where it ends.
Plan drawn_plan(const Plan& like, Random& random) {
  constexpr double kFarthest_m = 0.25;
  Plan plan = like;
  plan.check_envelopes = true;
  plan.steps.clear();
  const int steps = 1 + static_cast<int>(3.0 * random.uniform());
  for (int i = 0; i < steps; ++i) {
    Step step;
    OutcomeRule& rule = step.outcomes[static_cast<std::size_t>(Outcome::kReached)];
    rule.successor = i + 1 == steps ? kSuccessorDone : static_cast<Successor>(i + 1);
    for (int axis = 0; axis < 3; ++axis) {
      step.displacement[axis] = random.uniform(-kFarthest_m, kFarthest_m);
      const double spread_m = 0.03 * random.uniform();
      rule.envelope.travelled_min[axis] = step.displacement[axis] - spread_m;
      rule.envelope.travelled_max[axis] = step.displacement[axis] + spread_m;
    }
    plan.steps.push_back(step);
  }
  return plan;
}

/// Step by step. @return the first step that is refused, and why
std::optional<ArmReach::Refusal> walked(const ArmReach& reach, const Plan& plan) {
  std::string why;
  auto place = reach.start(plan, why);
  if (!place) return ArmReach::Refusal{0, why};
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    place = place->after(plan.steps[i], {}, why);
    if (!place) return ArmReach::Refusal{i, why};
  }
  return std::nullopt;
}

/// @return how many of the plans the arm could execute
int agreeing(const Plan& like, const Cell& cell, int plans) {
  const CellReach reach(cell);
  Random random(16);
  int accepted = 0;
  for (int i = 0; i < plans; ++i) {
    const Plan plan = drawn_plan(like, random);
    const DryRun run = dry_run(plan, cell);
    const auto step_by_step = walked(reach, plan);
    const auto whole = reach.refusal(plan);
    EXPECT_EQ(run.refusals.empty(), !step_by_step) << "plan " << i;
    EXPECT_EQ(run.refusals.empty(), !whole) << "plan " << i;
    accepted += whole ? 0 : 1;
    if (!whole || !step_by_step) continue;
    EXPECT_EQ(whole->why, run.refusals.front()) << "plan " << i;
    EXPECT_EQ(step_by_step->step, whole->step) << "plan " << i;
  }
  return accepted;
}

TEST(CellReach, StepByStepSaysOfDrawnPlansWhatTheDryRunSays) {
  constexpr int kPlans = 60;
  const int by_gantry = agreeing(touch_and_slide_plan(), hand_made_cell(), kPlans);
  const int by_arm = agreeing(arm_plan(), hand_made_arm_cell(), kPlans);
  std::printf("of %d plans the gantry can execute %d, the arm %d\n", kPlans, by_gantry, by_arm);
  for (const int accepted : {by_gantry, by_arm}) {
    EXPECT_GT(accepted, kPlans / 10);
    EXPECT_LT(accepted, kPlans - kPlans / 10);
  }
}

TEST(CellReach, WhatIsHeldElsewhereIsInsideTheLimitsToo) {
  const Cell cell = hand_made_cell();
  const CellReach reach(cell);
  std::string why;
  const Plan plan = touch_and_slide_plan();
  const auto start = reach.start(plan, why);
  ASSERT_TRUE(start) << why;
  Pose tool = plan.start;
  tool.position_m.x() += 0.05;
  EXPECT_TRUE(start->elsewhere(tool, why)) << why;
  tool.position_m.x() += 1.0;
  EXPECT_FALSE(start->elsewhere(tool, why));
  EXPECT_NE(why.find("joint x would be at"), std::string::npos) << why;
}

TEST(CellReach, AnAxisThatTheArmLacksIsRefusedAtTheStart) {
  Plan plan = touch_and_slide_plan();
  plan.coordinates |= 0x20;
  std::string why;
  EXPECT_FALSE(CellReach(hand_made_cell()).start(plan, why));
  EXPECT_NE(why.find("moved axes"), std::string::npos) << why;
}

}  // namespace
}  // namespace tenon::executor
