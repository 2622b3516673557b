// After the drives are off, the brakes hold or one does not; and what a stop costs until they do.
// The truth is the virtual arm's.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "executor/telemetry/run_result.h"
#include "tests/support/faulty_options.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;

constexpr std::size_t kVertical = 2;  // the gantry's z

TEST(Brakes, OneThatDoesNotHoldIsNamedAndTheRunIsNotDone) {
  const auto result = WholeRun(gantry_cell(), box_task(), box_plan("1"),
                               with_faults({"brake-failure:node=3,time_s=9"}))
                          .run();
  EXPECT_EQ(result.ending.reason, EndReason::kBrakeFailed) << result.reason;
  EXPECT_TRUE(result.ending.disable_confirmed);
  EXPECT_EQ(result.ending.index, static_cast<int>(kVertical));
  EXPECT_NE(result.reason.find("joint z moved by"), std::string::npos) << result.reason;
  EXPECT_NE(result.reason.find("its brake does not hold"), std::string::npos) << result.reason;
}

// What tenon-exec prints at once.
class FirstLine : public executor::CycleSink {
 public:
  explicit FirstLine(const Cell& cell) : cell_(cell) {}
  void record(const executor::CycleRecord& record) noexcept override {
    if (line.empty()) line = executor::hold_line(record, cell_);
  }
  std::string line;

 private:
  Cell cell_;
};

TEST(Brakes, WhereTheCellWantsItPowerComesBackUntilTheUserStops) {
  Cell cell = gantry_cell();
  cell.hold_if_brake_fails = true;
  FirstLine told(cell);
  WholeRun run(cell, box_task(), box_plan("1"), with_faults({"brake-failure:node=3,time_s=9"}),
               &told);
  ASSERT_TRUE(run.prepare());
  while (run.cycle() && run.controller().state() != executor::State::kCatching) {
    ASSERT_EQ(told.line, "");
  }
  ASSERT_EQ(run.controller().state(), executor::State::kCatching);
  EXPECT_EQ(told.line, "") << "power is not back yet";
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(run.cycle());
  EXPECT_EQ(told.line.rfind("joint z moved by", 0), 0U) << told.line;
  EXPECT_NE(told.line.find("its brake does not hold; it is held under power"), std::string::npos)
      << told.line;
  const double held = run.result().truth.drives[kVertical].position;
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(run.cycle());
  const sim::DriveTruth drive = run.result().truth.drives[kVertical];
  EXPECT_NEAR(drive.position, held, 1e-4) << "it is held";
  EXPECT_EQ(drive.state, "operation enabled");
  run.controller().request_stop();
  for (int i = 0; i < 2000 && run.cycle(); ++i) {
  }
  EXPECT_TRUE(run.controller().finished());
  EXPECT_EQ(run.result().ending.reason, EndReason::kBrakeFailed);
}

// An arm that is in a fault holds nothing: nobody has to wait for it.
TEST(Brakes, AFaultOfTheArmEndsTheHolding) {
  Cell cell = gantry_cell();
  cell.hold_if_brake_fails = true;
  WholeRun run(cell, box_task(), box_plan("1"),
               with_faults({"brake-failure:node=3,time_s=9", "silent-node:node=1,time_s=40"}));
  ASSERT_TRUE(run.prepare());
  bool held = false;
  for (int i = 0; i < 30'000 && run.cycle(); ++i) {
    held = held || run.controller().state() == executor::State::kCatching;
  }
  EXPECT_TRUE(held);
  EXPECT_TRUE(run.controller().finished());
  EXPECT_EQ(run.result().ending.reason, EndReason::kBrakeFailed);
}

// --- after another end ------------------------------------------------------------------------

// A force of 80 N that nobody feels but the executor, and then the brake of an axis under gravity.
WholeRun::Options force_and_then(const std::vector<std::string>& more) {
  std::vector<std::string> faults = more;
  faults.emplace_back("forged-force:at=free,time_s=0.3,force_N=80,duration_s=0.01");
  WholeRun::Options options = with_faults(faults);
  options.start = std::string("4");
  return options;
}

TEST(Brakes, OneThatSlipsAfterAFaultIsSaidBesideTheFaultsName) {
  const auto result = WholeRun(gantry_cell(), box_task(), box_plan("4"),
                               force_and_then({"brake-failure:node=3,at=stopping"}))
                          .run();
  EXPECT_EQ(result.ending.reason, EndReason::kForceFault) << result.reason;
  EXPECT_EQ(result.reason.rfind("external force ", 0), 0U) << result.reason;
  EXPECT_NE(result.reason.find("; then joint z moved by"), std::string::npos) << result.reason;
  EXPECT_NE(result.reason.find("its brake does not hold"), std::string::npos) << result.reason;
  EXPECT_EQ(result.reason.find("for want of answers"), std::string::npos) << result.reason;
}

TEST(Brakes, AfterAFaultPowerIsKeptWhereTheCellWantsIt) {
  Cell cell = gantry_cell();
  cell.hold_if_brake_fails = true;
  FirstLine told(cell);
  WholeRun run(cell, box_task(), box_plan("4"),
               force_and_then({"brake-failure:node=3,at=stopping"}), &told);
  ASSERT_TRUE(run.prepare());
  const auto caught = [&] { return run.controller().state() == executor::State::kCatching; };
  for (int i = 0; i < 30'000 && !caught() && run.cycle(); ++i) {
  }
  ASSERT_TRUE(caught());
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(run.cycle());
  EXPECT_EQ(told.line.rfind("joint z moved by", 0), 0U) << told.line;
  const double held = run.result().truth.drives[kVertical].position;
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(run.cycle());
  ASSERT_TRUE(caught());
  EXPECT_NEAR(run.result().truth.drives[kVertical].position, held, 1e-4) << "it is held";
  run.controller().request_stop();
  for (int i = 0; i < 2000 && run.cycle(); ++i) {
  }
  EXPECT_TRUE(run.controller().finished());
  EXPECT_EQ(run.result().ending.reason, EndReason::kForceFault) << "the first cause stays";
}

// One drive that nobody hears hides no other.
TEST(Brakes, WhereANodesAnswersAreLostTheOthersAreWatchedAndThatIsSaid) {
  const auto result =
      WholeRun(gantry_cell(), box_task(), box_plan("4"),
               force_and_then({"brake-failure:node=3,at=stopping",
                               "drop:node=1,id=answers,at=stopping,duration_s=100"}))
          .run();
  EXPECT_EQ(result.ending.reason, EndReason::kForceFault) << result.reason;
  EXPECT_FALSE(result.ending.disable_confirmed);
  EXPECT_NE(result.reason.find("; then joint z moved by"), std::string::npos) << result.reason;
  EXPECT_NE(result.reason.find("for want of answers nobody could watch whether the brake holds at "
                               "node 1 (x)"),
            std::string::npos)
      << result.reason;
}

TEST(Brakes, OneThatNobodyCanWatchIsSaidSo) {
  const auto result = WholeRun(gantry_cell(), box_task(), box_plan("4"),
                               force_and_then({"brake-failure:node=3,at=stopping",
                                               "drop:node=3,id=answers,at=stopping,duration_s=99"}))
                          .run();
  EXPECT_EQ(result.ending.reason, EndReason::kForceFault) << result.reason;
  EXPECT_NE(result.reason.find("nobody could watch whether the brake holds at node 3 (z)"),
            std::string::npos)
      << result.reason;
}

// A fault of the sensor, and then the quick stop: by how much does an axis under gravity move from
// rest to the brake?
TEST(Brakes, AStopAfterAFaultLetsNoAxisDrop) {
  WholeRun run(gantry_cell(), box_task(), box_plan("1"),
               with_faults({"silent-node:node=4,time_s=4"}));
  ASSERT_TRUE(run.prepare());
  double lowest = 1.0;
  double at_rest = 0.0;
  while (run.cycle()) {
    const double position = run.result().truth.drives[kVertical].position;
    if (run.controller().state() == executor::State::kDisabling && at_rest == 0.0) {
      at_rest = position;
    }
    if (at_rest != 0.0) lowest = std::min(lowest, position);
  }
  EXPECT_EQ(run.result().ending.reason, EndReason::kArmFault);
  EXPECT_TRUE(run.result().ending.disable_confirmed) << "the drives said so";
  EXPECT_LT(std::abs(at_rest - lowest), 1e-5);
}

}  // namespace
}  // namespace tenon::tests
