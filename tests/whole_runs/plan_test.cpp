// A plan from its bring-up to the brakes, in lockstep, with what can befall it on the way.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "executor/telemetry/recorder.h"
#include "executor/telemetry/run_result.h"
#include "executor/telemetry/telemetry.h"
#include "executor/telemetry/trace.h"
#include "tests/support/faulty_options.h"
#include "tests/support/planned.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;

void expect_brakes(const sim::Truth& truth) {
  for (const auto& drive : truth.drives) EXPECT_TRUE(drive.brake_engaged) << drive.joint;
}

// Log, trace and black box are written along, as tenon-exec writes them.
TEST(WholePlan, RidesOutOneFaultOfEachKindAndEndsAtTheGoal) {
  const ScratchFolder folder;
  const auto recorder = std::make_unique<executor::Recorder>();
  WholeRun run(gantry_cell(), box_task(), box_plan("1"),
               with_faults({"drop:node=1,time_s=4",
                            "duplicate:node=2,time_s=2,duration_s=100,probability=0.2",
                            "corrupt-length:node=3,time_s=5",
                            "delay:node=2,time_s=6,duration_s=0.006,delay_s=0.0012",
                            "queue-full:node=127,time_s=7,duration_s=0.003"}),
               recorder.get());
  std::vector<std::string> warnings;
  executor::Telemetry telemetry(
      executor::open_telemetry("none", folder.path() / "run.lcmlog", warnings), gantry_cell(),
      &run.controller().runner(), *recorder);
  executor::TraceWriter trace(folder.path() / "run.trace", run.controller().runner());
  recorder->add(telemetry);
  recorder->add(trace);
  ASSERT_TRUE(run.prepare());
  while (run.cycle()) recorder->drain();
  recorder->drain();

  const auto result = run.result();
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
  EXPECT_LT(result.truth.error_norm_m, box_task().goal_tolerance_m);
  EXPECT_EQ(run.arm().counters().malformed_frames, 1U);
  EXPECT_GT(run.arm().counters().late_frames, 0U);
  EXPECT_GT(run.arm().counters().send_failures, 0U);
  expect_brakes(result.truth);

  const auto gathered = executor::gather_result(run.controller(), run.runner(), 0, "");
  telemetry.publish_summary(gathered, run.controller().record());
  EXPECT_EQ(telemetry.failures(), 0U);
  EXPECT_FALSE(executor::to_json(gathered, gantry_cell()).empty());
  EXPECT_TRUE(run.runner().black_box().write_csv(folder.path() / "black-box.csv").whole());
  EXPECT_GT(folder.get("black-box.csv").size(), 10'000U);
}

TEST(WholePlan, ADriveThatFallsSilentEndsItByNameWithTheOthersBraked) {
  WholeRun run(gantry_cell(), box_task(), box_plan("1"),
               with_faults({"drop:node=2,time_s=4,duration_s=100"}));
  const auto result = run.run();
  EXPECT_EQ(result.ending.reason, EndReason::kArmFault) << result.reason;
  EXPECT_EQ(result.ending.arm_fault.kind, ArmFaultKind::kFeedbackMissing) << result.reason;
  EXPECT_EQ(result.ending.arm_fault.node, 2) << result.reason;
  run.leave_alone(2.0);
  expect_brakes(run.cell().truth());
}

TEST(WholePlan, AStopInMidMotionEndsItOnRequestWithBrakesOn) {
  WholeRun run(gantry_cell(), box_task(), box_plan("1"), with_faults({}));
  ASSERT_TRUE(run.prepare());
  for (int moving = 0; moving < 400;) {
    ASSERT_TRUE(run.cycle());
    moving += run.controller().state() == executor::State::kRunning;
  }
  run.controller().request_stop();
  while (run.cycle()) {
  }
  const auto result = run.result();
  EXPECT_EQ(result.ending.reason, EndReason::kStopRequested) << result.reason;
  expect_brakes(result.truth);
}

}  // namespace
}  // namespace tenon::tests
