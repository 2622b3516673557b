// The loop's own run() in virtual time: it wakes late, and what that comes to.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "executor/telemetry/run_result.h"
#include "tests/support/faulty_options.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::int64_t kCycle_ns = 2 * kMillisecond_ns;

TEST(LateLoop, OnTimeItIsTheRunThatLockstepMakes) {
  WholeRun stepped(gantry_cell(), box_task(), box_plan("1"), with_faults({}));
  WholeRun clocked(gantry_cell(), box_task(), box_plan("1"), with_faults({}));
  const auto expected = stepped.run();
  const auto result = clocked.run_on_clock([](std::int64_t) { return 0; });
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
  EXPECT_EQ(clocked.runner().statistics().late_cycles, 0U);
  EXPECT_EQ(clocked.runner().statistics().incomplete_cycles, 0U);
  EXPECT_EQ(clocked.runner().statistics().cycles, stepped.runner().statistics().cycles);
  EXPECT_LT((result.truth.tool.position_m - expected.truth.tool.position_m).norm(), 1e-9);
}

// 300 us late, then 1.7 ms early in the next cycle's eyes: the phase stays.
TEST(LateLoop, AWakeUpWithinItsPeriodSkipsNoCycle) {
  WholeRun run(gantry_cell(), box_task(), box_plan("1"), with_faults({}));
  const auto result = run.run_on_clock(
      [](std::int64_t due_ns) { return due_ns / kCycle_ns % 100 == 0 ? 300'000 : 0; });
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
  EXPECT_EQ(run.runner().statistics().late_cycles, 0U);
}

TEST(LateLoop, OneLateCycleIsCountedAndRiddenOut) {
  WholeRun run(gantry_cell(), box_task(), box_plan("1"), with_faults({}));
  bool late = false;
  const auto result = run.run_on_clock([&](std::int64_t due_ns) {
    if (late || due_ns < 4000 * kMillisecond_ns) return std::int64_t{0};
    late = true;
    return 3 * kMillisecond_ns;
  });
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
  EXPECT_EQ(run.runner().statistics().late_cycles, 1U);
}

TEST(LateLoop, ALoopThatIsLateAgainAndAgainIsEndedByName) {
  WholeRun run(gantry_cell(), box_task(), box_plan("1"), with_faults({}));
  const auto result = run.run_on_clock([](std::int64_t due_ns) {
    return due_ns > 4000 * kMillisecond_ns ? 3 * kMillisecond_ns : 0;
  });
  EXPECT_TRUE(result.ending.reason == EndReason::kOverruns ||
              result.ending.reason == EndReason::kBlind)
      << result.reason;
  for (const auto& drive : result.truth.drives) EXPECT_TRUE(drive.brake_engaged) << drive.joint;
}

// The table is where the plan does not look. That a late loop may be why is said where it was one.
TEST(LateLoop, APlanThatFailsSaysSoOfALoopThatWasLate) {
  WholeRun::Options options = with_faults({});
  options.offset << 0.3, 0.3, 0.0, 0.0, 0.0, 0.0;
  for (const double late_ms : {0.0, 1.5, 7.0}) {
    WholeRun run(gantry_cell(), box_task(), box_plan("1"), options);
    (void)run.run_on_clock([&](std::int64_t due_ns) {
      const bool at_work = due_ns / kCycle_ns == 3000;
      return at_work ? static_cast<std::int64_t>(late_ms * kMillisecond_ns) : std::int64_t{0};
    });
    const auto result = executor::gather_result(run.controller(), run.runner(), 0, "");
    EXPECT_EQ(result.reason, EndReason::kPlanFailed) << result.message;
    const bool said = result.message.find("; the loop woke up 7 ms late") != std::string::npos;
    EXPECT_EQ(said, late_ms > 2.0) << result.message;
  }
}

// Its time is past before the run ends, and no cycle would have followed.
TEST(LateLoop, TheLastCyclesLatenessSkipsNone) {
  std::int64_t last_due_ns = 0;
  WholeRun on_time(gantry_cell(), box_task(), box_plan("1"), with_faults({}));
  (void)on_time.run_on_clock([&](std::int64_t due_ns) {
    last_due_ns = due_ns;
    return std::int64_t{0};
  });
  WholeRun run(gantry_cell(), box_task(), box_plan("1"), with_faults({}));
  const auto result = run.run_on_clock([&](std::int64_t due_ns) {
    return due_ns == last_due_ns ? 3 * kMillisecond_ns : std::int64_t{0};
  });
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
  EXPECT_EQ(run.runner().statistics().cycles, on_time.runner().statistics().cycles);
  EXPECT_EQ(run.runner().statistics().late_cycles, 0U);
}

}  // namespace
}  // namespace tenon::tests
