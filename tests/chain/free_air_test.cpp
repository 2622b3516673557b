// A tool that yields in all six axes and touches nothing: what the sensor feels of the payload's
// own motion must neither end a move nor the run.

#include <gtest/gtest.h>

#include <cstdio>

#include "executor/dry_run/plan_check.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

// Start 1 of the box task, and nothing in the way.
Task open_air(const Cell& cell) {
  Task task = planned_box(cell, "1").task;
  task.compliance.compliant_axes = 0x3F;
  task.environment = {{"far away", Shape::Kind::kBox, {0.01, 0.01, 0.01}, {}}};
  task.environment[0].pose.position_m = {0.0, 0.0, -3.0};
  return task;
}

// Along and about every axis, and back.
Plan back_and_forth(const Cell& cell, const Task& task) {
  Plan plan = planned_box(cell, "1").plan;
  plan.goal = plan.start;
  plan.compliance = task.compliance;
  plan.method = PlanMethod::kSingleParticle;
  plan.check_envelopes = false;
  plan.parameter_sets.resize(1);
  plan.steps.clear();
  for (int axis = 0; axis < 6; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Step step;
      step.displacement[axis] = sign * (axis < 3 ? 0.05 : 0.15);
      step.outcomes[static_cast<std::size_t>(Outcome::kReached)].successor =
          static_cast<Successor>(plan.steps.size() + 1);
      plan.steps.push_back(step);
    }
  }
  plan.steps.back().outcomes[static_cast<std::size_t>(Outcome::kReached)].successor =
      kSuccessorDone;
  return plan;
}

WholeRun::Result fly(const Cell& cell, const Task& task, const Plan& plan) {
  WholeRun::Options options;
  options.start = "1";
  WholeRun run(cell, task, plan, options);
  const auto result = run.run();
  std::printf("%zu steps, peak %.2f N, %.3f Nm\n", result.steps, run.controller().peak_force_N(),
              run.controller().peak_torque_Nm());
  return result;
}

TEST(FreeAir, ASixAxisArmThatYieldsInRotationFeelsNoContactInItsOwnMotion) {
  const Cell cell = shipped_cell("csp6");
  const Task task = open_air(cell);
  const Plan plan = back_and_forth(cell, task);
  EXPECT_TRUE(executor::check_plan(plan, cell).empty());
  const auto result = fly(cell, task, plan);
  EXPECT_EQ(result.ending.reason, executor::EndReason::kPlanDone) << result.reason;
  EXPECT_EQ(result.steps, 12U);
}

// A virtual inertia that the payload's outweighs answers to every torque by one of its own.
TEST(FreeAir, AnInertiaThatThePayloadOutweighsIsRefusedAndFaultsWhenForced) {
  const Cell cell = shipped_cell("csp6");
  const Task task = open_air(cell);
  Plan plan = back_and_forth(cell, task);
  plan.compliance.inertia_kgm2 = 0.016;
  const auto refusals = executor::check_plan(plan, cell);
  ASSERT_EQ(refusals.size(), 1U);
  EXPECT_EQ(refusals[0],
            "inertia = 0.016 kg m^2, must be at least 1.5 m r^2 = 1.5 * 1 * 0.11^2 = 0.01815 kg "
            "m^2 of the payload about the tool tip");
  EXPECT_NE(fly(cell, task, plan).ending.reason, executor::EndReason::kPlanDone);
}

}  // namespace
}  // namespace tenon::tests
