// The way in for a library user: a plan and feedback in, setpoints out.

#include "executor/plan_executor.h"

#include <gtest/gtest.h>

#include <vector>

#include "shared/base/error.h"
#include "tests/executor/bench.h"
#include "tests/support/allocation_count.h"
#include "tests/support/hand_made.h"

namespace tenon::executor {
namespace {

constexpr double kWall_m = 0.13;

// A springy wall along x, and an arm that is where it was told to be one cycle ago.
class Room {
 public:
  explicit Room(const Pose& start) { input.tool = start; }
  void answer(const PlanExecutor::Output& output) {
    input.tool = output.tool;
    input.wrench[0] = -5e4 * std::max(0.0, input.tool.position_m.x() - kWall_m);
  }
  PlanExecutor::Input input;
};

struct Executed {
  PlanExecutor::Result result = PlanExecutor::Result::kRunning;
  std::vector<StepReport> steps;
  PlanExecutor::Output last;
  std::uint64_t allocations = 0;
};

Executed execute(PlanExecutor& executor) {
  Executed executed;
  executed.steps.reserve(kMaxSteps);
  Room room(executor.plan().start);
  for (int cycle = 0; executed.result == PlanExecutor::Result::kRunning && cycle < 50'000;
       ++cycle) {
    const std::uint64_t before = tests::allocation_count();
    executed.result = executor.update(room.input, executed.last);
    executed.allocations += tests::allocation_count() - before;
    if (executed.last.finished != nullptr) executed.steps.push_back(*executed.last.finished);
    room.answer(executed.last);
  }
  return executed;
}

TEST(PlanExecutor, APlanRunsToItsEndAndEveryStepIsToldOnce) {
  PlanExecutor executor(touch_and_slide_plan(), {.cycle_s = 0.002});
  const Executed executed = execute(executor);
  EXPECT_EQ(executed.result, PlanExecutor::Result::kDone);
  ASSERT_EQ(executed.steps.size(), 2U);
  EXPECT_EQ(executor.runner().report_count(), 2U);
  EXPECT_EQ(executed.steps[0].result.outcome, Outcome::kContact);
  EXPECT_NEAR(executed.steps[0].result.travelled[0], kWall_m - 0.1, 1e-3);
  EXPECT_TRUE(executed.steps[0].result.signature.has(0, -1));
  EXPECT_EQ(executed.steps[1].result.outcome, Outcome::kReached);
  EXPECT_NEAR(executed.last.tool.position_m.y(), 0.04, 1e-3);
  EXPECT_EQ(executed.last.setpoint.velocity.norm(), 0.0);
}

TEST(PlanExecutor, ItsStepsAreThoseOfAWholeArm) {
  PlanExecutor executor(touch_and_slide_plan(), {.cycle_s = 0.002});
  const Executed executed = execute(executor);
  Bench bench(touch_and_slide_plan());
  bench.arm.walls.push_back({0, +1, kWall_m});
  bench.run();
  const PlanRunner& whole = bench.controller.runner();
  ASSERT_EQ(executed.steps.size(), whole.report_count());
  for (std::size_t i = 0; i < whole.report_count(); ++i) {
    EXPECT_EQ(executed.steps[i].step, whole.report(i).step);
    EXPECT_EQ(executed.steps[i].result.outcome, whole.report(i).result.outcome);
    EXPECT_EQ(executed.steps[i].result.signature, whole.report(i).result.signature);
    EXPECT_LT((executed.steps[i].result.travelled - whole.report(i).result.travelled).norm(), 5e-4);
  }
}

TEST(PlanExecutor, AnOutcomeThatThePlanDoesNotKnowFailsItAndTheLastSetpointHolds) {
  Plan plan = touch_and_slide_plan();
  plan.start.position_m.x() = 0.0;  // 50 mm further on there is no wall
  PlanExecutor executor(plan, {.cycle_s = 0.002});
  Executed executed = execute(executor);
  EXPECT_EQ(executed.result, PlanExecutor::Result::kFailed);
  ASSERT_EQ(executed.steps.size(), 1U);
  EXPECT_EQ(executed.steps[0].transition.deviation, Deviation::kUnexpectedOutcome);
  const Pose held = executed.last.setpoint.pose;
  PlanExecutor::Input input{.tool = executed.last.tool};
  EXPECT_EQ(executor.update(input, executed.last), PlanExecutor::Result::kFailed);
  EXPECT_EQ(executed.last.setpoint.pose, held);
  EXPECT_EQ(executed.last.finished, nullptr);
}

TEST(PlanExecutor, UpdatesAllocateNothing) {
  PlanExecutor executor(touch_and_slide_plan(), {.cycle_s = 0.002});
  const Executed executed = execute(executor);
  EXPECT_EQ(executed.steps.size(), 2U);
  EXPECT_EQ(executed.allocations, 0U);
}

TEST(PlanExecutor, APlanWithoutStepsIsRefused) {
  EXPECT_THROW(PlanExecutor(hand_made_plan(), {}), InputError);
}

}  // namespace
}  // namespace tenon::executor
