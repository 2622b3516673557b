// What was executed, replayed offline from its trace, is the same bit for bit.

#include "executor/telemetry/trace.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "executor/telemetry/recorder.h"
#include "shared/base/error.h"
#include "tests/executor/bench.h"
#include "tests/support/refusal.h"

namespace tenon::executor {
namespace {

std::filesystem::path temporary(const char* name) {
  return std::filesystem::path(testing::TempDir()) / name;
}

// Runs touch_and_slide_plan() on a noisy arm and leaves its trace in `file`.
void record_run(const std::filesystem::path& file, const Cell& cell = hand_made_cell()) {
  const auto recorder = std::make_unique<Recorder>();
  Bench bench(touch_and_slide_plan(), {}, cell, Vector3::Zero(), recorder.get());
  bench.arm.walls.push_back({0, +1, 0.13});
  bench.arm.noise_N = 0.1;
  TraceWriter writer(file, bench.controller.runner());
  recorder->add(writer);
  bench.run([&] { recorder->drain(); });
  recorder->drain();
  ASSERT_EQ(bench.controller.ending().reason, EndReason::kPlanDone);
  ASSERT_EQ(recorder->dropped(), 0U);
}

TEST(Trace, AReplayedRunGivesTheSameBits) {
  const std::filesystem::path file = temporary("tenon_trace_test.txt");
  record_run(file);
  const std::vector<TracedMove> moves = read_trace(file);
  ASSERT_EQ(moves.size(), 2U);
  const Plan plan = touch_and_slide_plan();
  for (const TracedMove& traced : moves) {
    ASSERT_TRUE(traced.complete);
    ASSERT_GT(traced.inputs.size(), 50U);
    GuardedMove move(move_parameters(plan, traced), traced.signature_before, traced.held);
    for (const TracedInput& input : traced.inputs) {
      EXPECT_FALSE(move.result().has_value());
      ASSERT_EQ(move.update(input.input).setpoint.pose, input.setpoint);
    }
    ASSERT_TRUE(move.result().has_value());  // at the last input, neither earlier nor later
    EXPECT_EQ(move.result()->outcome, traced.outcome);
    EXPECT_EQ(move.result()->signature, traced.signature);
    EXPECT_EQ(move.result()->decided_ns, traced.decided_ns);
    EXPECT_EQ(move.result()->duration_ns, traced.duration_ns);
  }
  EXPECT_EQ(moves[0].outcome, Outcome::kContact);
  std::filesystem::remove(file);
}

TEST(Trace, AStepThatTheDryRunSlowedIsReplayedAtTheSpeedsOfTheTrace) {
  const std::filesystem::path file = temporary("tenon_trace_slow_test.txt");
  Cell cell = hand_made_cell();
  cell.robot.joints[1].speed_max = 0.03;
  record_run(file, cell);
  const TracedMove traced = read_trace(file).back();
  const Plan plan = touch_and_slide_plan();
  EXPECT_LT(traced.speeds.contact_mps, 0.7 * plan.parameter_sets[0].speeds.contact_mps);
  GuardedMove as_executed(move_parameters(plan, traced), traced.signature_before, traced.held);
  GuardedMove as_planned(move_parameters(plan, traced.step), traced.signature_before, traced.held);
  bool differs = false;
  for (const TracedInput& input : traced.inputs) {
    ASSERT_EQ(as_executed.update(input.input).setpoint.pose, input.setpoint);
    differs = differs || !(as_planned.update(input.input).setpoint.pose == input.setpoint);
  }
  EXPECT_TRUE(differs);
  std::filesystem::remove(file);
}

TEST(Trace, AnotherThresholdMakesAnotherMoveOfTheSameTrace) {
  const std::filesystem::path file = temporary("tenon_trace_threshold_test.txt");
  record_run(file);
  const TracedMove traced = read_trace(file).front();
  Plan plan = touch_and_slide_plan();
  plan.parameter_sets[0].thresholds.force_on_N = 3.5;
  GuardedMove move(move_parameters(plan, traced), traced.signature_before, traced.held);
  bool differs = false;
  for (const TracedInput& input : traced.inputs) {
    differs = differs || !(move.update(input.input).setpoint.pose == input.setpoint);
  }
  EXPECT_TRUE(differs);
  std::filesystem::remove(file);
}

TEST(Trace, ATraceWithLostRecordsIsRefused) {
  const std::filesystem::path file = temporary("tenon_trace_gap_test.txt");
  {
    Bench bench(touch_and_slide_plan());
    TraceWriter writer(file, bench.controller.runner());
    CycleRecord record;
    record.sequence = 4;
    writer.consume(record);
    record.sequence = 6;
    writer.consume(record);
  }
  EXPECT_THROW((void)read_trace(file), InputError);
  std::filesystem::remove(file);
}

TEST(Trace, GarbageIsRefusedByItsLine) {
  const std::filesystem::path file = temporary("tenon_trace_garbage_test.txt");
  std::ofstream(file) << "tenon-trace 2\nm 0 0 1 0 0 0 0 0 0 0 0\ni 12 zz\n";
  EXPECT_EQ(tests::refusal([&] { (void)read_trace(file); }),
            file.string() + ":3: 'zz' is not a number");
  std::ofstream(file) << "something else\n";
  EXPECT_THROW((void)read_trace(file), InputError);
  std::filesystem::remove(file);
  EXPECT_THROW((void)read_trace(file), InputError);
}

}  // namespace
}  // namespace tenon::executor
