// The executor's two threads as tenon-exec has them: the control loop on the clock, and the one
// that empties its ring into log, trace and step lines. Nothing here depends on how late the loop
// wakes up.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "executor/loop/controller.h"
#include "executor/loop/cycle_runner.h"
#include "executor/telemetry/recorder.h"
#include "executor/telemetry/run_result.h"
#include "executor/telemetry/telemetry.h"
#include "executor/telemetry/trace.h"
#include "tests/support/hand_made.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/wall_arm.h"

namespace tenon::executor {
namespace {

// As late as it likes.
CycleRunner::Parameters patient() {
  CycleRunner::Parameters parameters;
  parameters.late.capacity = 1e9;
  parameters.incomplete.capacity = 1e9;
  parameters.black_box_s = 0.1;
  return parameters;
}

TelemetryOutputs log_to(const std::string& file) {
  std::vector<std::string> warnings;
  return open_telemetry("none", file, warnings);
}

/// How far a run has come, told on the recorder's thread and asked on the test's.
class Progress : public RecordConsumer {
 public:
  void consume(const CycleRecord& record) override {
    if (record.state == State::kRunning) running_.fetch_add(1, std::memory_order_relaxed);
  }
  [[nodiscard]] int running() const { return running_.load(std::memory_order_relaxed); }

 private:
  std::atomic<int> running_{0};
};

/// One run; its files are whole once this is gone.
class TwoThreads {
 public:
  explicit TwoThreads(const tests::ScratchFolder& folder)
      : folder_(folder),
        arm_(hand_made_cell(), plan_.start),
        controller_(hand_made_cell(), plan_, {}),
        runner_(arm_, controller_, recorder_.get(), patient()),
        telemetry_(log_to(file("run.lcmlog")), hand_made_cell(), &controller_.runner(), *recorder_),
        trace_(file("run.trace"), controller_.runner()) {
    arm_.walls.push_back({0, +1, 0.13});
    recorder_->add(telemetry_);
    recorder_->add(trace_);
    recorder_->add(progress_);
    (void)arm_.prepare(0);
  }

  /// To the end. @param stop_after running cycles that have been recorded; 0: no stop
  RunResult run(int stop_after) {
    StopRequests stop;
    recorder_->start();
    std::thread loop([&] { runner_.run(stop); });
    if (stop_after > 0) {
      while (progress_.running() < stop_after)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      stop.by_user = true;
    }
    loop.join();
    recorder_->stop();
    const RunResult result = gather_result(controller_, runner_, recorder_->dropped(), "");
    telemetry_.publish_summary(result, controller_.record());
    EXPECT_EQ(telemetry_.failures(), 0U);
    EXPECT_TRUE(runner_.black_box().write_csv(file("box.csv")).whole());
    return result;
  }

 private:
  [[nodiscard]] std::string file(const std::string& name) const { return folder_.path() / name; }

  const tests::ScratchFolder& folder_;
  Plan plan_ = touch_and_slide_plan();
  std::unique_ptr<Recorder> recorder_ = std::make_unique<Recorder>();
  WallArm arm_;
  Controller controller_;
  CycleRunner runner_;
  Telemetry telemetry_;
  TraceWriter trace_;
  Progress progress_;
};

std::size_t events_in(const std::string& file, const std::string& channel) {
  lcm::LogFile log(file, "r");
  EXPECT_TRUE(log.good());
  std::size_t events = 0;
  while (const lcm::LogEvent* event = log.readNextEvent()) events += event->channel == channel;
  return events;
}

TEST(ExecutorThreads, AWholeRunLeavesLogTraceAndBlackBox) {
  const tests::ScratchFolder folder;
  const RunResult result = TwoThreads(folder).run(0);
  EXPECT_EQ(result.reason, EndReason::kPlanDone) << result.message;
  EXPECT_EQ(result.steps.size(), 2U);
  const std::string log = folder.path() / "run.lcmlog";
  EXPECT_EQ(events_in(log, kCycleChannel) + result.records_dropped, result.statistics.cycles);
  EXPECT_EQ(events_in(log, kStepChannel), 2U);
  EXPECT_EQ(events_in(log, kRunChannel), 1U);
  if (result.records_dropped == 0) {
    EXPECT_EQ(read_trace(folder.path() / "run.trace").size(), 2U);
  }
  EXPECT_GT(folder.get("box.csv").size(), 1000U);
}

TEST(ExecutorThreads, AStopFromAnotherThreadEndsTheRunInGoodOrder) {
  const tests::ScratchFolder folder;
  const RunResult result = TwoThreads(folder).run(50);
  EXPECT_EQ(result.reason, EndReason::kStopRequested) << result.message;
  EXPECT_TRUE(result.disable_confirmed);
  EXPECT_EQ(events_in(folder.path() / "run.lcmlog", kRunChannel), 1U);
}

}  // namespace
}  // namespace tenon::executor
