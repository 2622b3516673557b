// A plan whose steps wait for the user's word.

#include <gtest/gtest.h>

#include <cmath>

#include "executor/loop/controller.h"
#include "tests/executor/bench.h"

namespace tenon::executor {
namespace {

// Enter before every step: nothing moves before it, one step runs after it, and an Enter that came
// while none waited counts for nothing.
TEST(StepByStep, EveryStepWaitsForItsOwnWord) {
  Controller::Parameters parameters;
  parameters.step_by_step = true;
  Bench bench(touch_and_slide_plan(), parameters);
  bench.arm.walls.push_back({0, +1, 0.13});
  bench.controller.allow_step();
  bench.run_until(State::kRunning);
  const Pose start = bench.arm.tool();
  for (int step = 0; step < 2; ++step) {
    for (int i = 0; i < 500; ++i) ASSERT_TRUE(bench.step());
    EXPECT_EQ(bench.controller.runner().report_count(), static_cast<std::size_t>(step));
    EXPECT_EQ(bench.controller.record().awaited_step, step);
    EXPECT_FALSE(bench.controller.record().moving);
    if (step == 0) {
      EXPECT_LT(displacement_between(start, bench.arm.tool()).norm(), 1e-9);
    }
    bench.controller.allow_step();
    ASSERT_TRUE(bench.step());
    EXPECT_TRUE(bench.controller.record().moving);
    EXPECT_EQ(bench.controller.record().awaited_step, -1);
    bench.controller.allow_step();
  }
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanDone) << bench.ending();
}

// Waiting is no pause of the supervision, and a stop needs no Enter.
TEST(StepByStep, AStepThatWaitsIsWatchedAndStopsWhenAsked) {
  Controller::Parameters parameters;
  parameters.step_by_step = true;
  Bench pushed(touch_and_slide_plan(), parameters);
  pushed.run_until(State::kRunning);
  pushed.arm.push[1] = 80.0;
  pushed.run();
  EXPECT_EQ(pushed.controller.ending().reason, EndReason::kForceFault) << pushed.ending();

  Bench stopped(touch_and_slide_plan(), parameters);
  stopped.run_until(State::kRunning);
  stopped.controller.request_stop();
  stopped.run();
  EXPECT_EQ(stopped.controller.ending().reason, EndReason::kStopRequested) << stopped.ending();
  EXPECT_EQ(stopped.controller.runner().report_count(), 0U);
}

// In free air the wrench has no cause to move; in a contact it may have many.
TEST(StepByStep, ATareThatDriftsWhileAStepWaitsInFreeAirIsNamed) {
  Controller::Parameters parameters;
  parameters.step_by_step = true;
  for (const double rate_Nps : {0.0, 0.5}) {
    Bench bench(touch_and_slide_plan(), parameters);
    bench.run_until(State::kRunning);
    for (int i = 0; i < 1000 && bench.controller.state() == State::kRunning; ++i) {
      bench.arm.bias[2] += 2e-3 * rate_Nps;
      ASSERT_TRUE(bench.step());
    }
    const bool drifts = rate_Nps > 0.0;
    EXPECT_EQ(bench.controller.state() == State::kRunning, !drifts) << bench.ending();
    EXPECT_EQ(bench.controller.ending().reason, drifts ? EndReason::kTareDrift : EndReason::kNone);
    EXPECT_EQ(std::abs(bench.controller.ending().value) > bench.controller.ending().bound, drifts);
  }
}

// At the tip, 8 cm from the sensor, the same noise is a torque far beyond that of the data sheet.
TEST(StepByStep, TheNoiseOfASensorFarFromTheTipIsNoDrift) {
  Controller::Parameters parameters;
  parameters.step_by_step = true;
  Bench bench(touch_and_slide_plan(), parameters);
  bench.arm.noise_N = 0.27;  // of 0.3 that the tare lets pass
  bench.run_until(State::kRunning);
  for (int i = 0; i < 40'000; ++i) {
    ASSERT_TRUE(bench.step());
    ASSERT_EQ(bench.controller.state(), State::kRunning) << i << ": " << bench.ending();
  }
}

TEST(StepByStep, AWrenchThatMovesWhileAStepWaitsInAContactIsNoDrift) {
  Controller::Parameters parameters;
  parameters.step_by_step = true;
  Bench bench(touch_and_slide_plan(), parameters);
  bench.arm.walls.push_back({0, +1, 0.13});
  bench.run_until(State::kRunning);
  for (int i = 0; i < 20'000 && bench.controller.runner().report_count() == 0; ++i) {
    bench.controller.allow_step();
    ASSERT_TRUE(bench.step());
  }
  for (int i = 0; i < 1000; ++i) {
    bench.arm.bias[2] += 1e-3;
    ASSERT_TRUE(bench.step()) << bench.ending();
    ASSERT_EQ(bench.controller.state(), State::kRunning) << bench.ending();
  }
}

}  // namespace
}  // namespace tenon::executor
