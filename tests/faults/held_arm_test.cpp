// Where the cell wants an arm held under power whose brake does not hold: it is, until somebody who
// has something under it says so, whatever came before and whatever the sensor says; and where it
// cannot be, that is told at once. The truth is the virtual arm's.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "executor/telemetry/run_result.h"
#include "shared/base/text.h"
#include "tests/support/faulty_options.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;
using executor::Hold;
using executor::State;

constexpr std::size_t kHeldAxis = 2;  // the gantry's z

/// What tenon-exec prints at once.
class Lines : public executor::CycleSink {
 public:
  explicit Lines(const Cell& cell) : cell_(cell) {}
  void record(const executor::CycleRecord& record) noexcept override {
    const std::string line = executor::hold_line(record, cell_);
    if (!line.empty() && (all.empty() || all.back() != line)) all.push_back(line);
  }
  std::vector<std::string> all;

 private:
  Cell cell_;
};

Cell holding_cell() {
  Cell cell = gantry_cell();
  cell.hold_if_brake_fails = true;
  return cell;
}

class HeldArm : public ::testing::Test {
 protected:
  void start(std::vector<std::string> more) {
    more.emplace_back("brake-failure:node=3,at=free");
    WholeRun::Options options = with_faults(more);
    options.start = std::string("4");
    run = std::make_unique<WholeRun>(holding_cell(), box_task(), box_plan("4"), options, &lines);
    ASSERT_TRUE(run->prepare());
  }
  [[nodiscard]] State state() const { return run->controller().state(); }
  [[nodiscard]] double height_m() const { return run->result().truth.drives[kHeldAxis].position; }
  void to_catching() {
    for (int i = 0; i < 30'000 && state() != State::kCatching && run->cycle(); ++i) {
    }
    ASSERT_EQ(state(), State::kCatching);
  }
  void cycles(int count) {
    for (int i = 0; i < count && run->cycle(); ++i) {
    }
  }
  /// Still held after so many cycles more, where it was after some of the first.
  void is_held(int count) {
    cycles(200);
    const double at_m = height_m();
    cycles(count);
    ASSERT_EQ(state(), State::kCatching) << run->result().reason;
    EXPECT_NEAR(height_m(), at_m, 1e-4);
    EXPECT_EQ(run->result().truth.drives[kHeldAxis].state, "operation enabled");
  }
  void stop_ends_it() {
    run->controller().request_stop();
    cycles(2000);
    EXPECT_TRUE(run->controller().finished());
    EXPECT_EQ(run->result().ending.hold, Hold::kHeld);
    EXPECT_NE(run->result().reason.find("; it was held under power until it was told to stop"),
              std::string::npos)
        << run->result().reason;
    EXPECT_EQ(lines.all.size(), 1U);
  }

  Lines lines{holding_cell()};
  std::unique_ptr<WholeRun> run;
};

// Who stopped the run has not said that something is under the arm.
TEST_F(HeldArm, TheStopThatEndedTheRunDoesNotEndTheHolding) {
  start({});
  cycles(1500);
  run->controller().request_stop();
  to_catching();
  is_held(2000);
  EXPECT_EQ(run->result().ending.reason, EndReason::kBrakeFailed) << run->result().reason;
  stop_ends_it();
}

// An end of input, a lost terminal: neither has anything under the arm.
TEST_F(HeldArm, NobodysWordEndsTheRunAndNotTheHolding) {
  start({});
  cycles(1500);
  run->controller().request_end();
  to_catching();
  for (std::uint32_t asked = 1; asked < 4; ++asked) {
    run->controller().request_end();
    is_held(500);
    EXPECT_EQ(run->controller().record().stops_unheeded, asked);
  }
  stop_ends_it();
}

// What is put under an arm pushes it.
TEST_F(HeldArm, AForceBeyondTheLimitLetsNothingFall) {
  start({"forged-force:time_s=40,force_N=80,duration_s=0.01"});
  to_catching();
  is_held(15'000);
  EXPECT_GT(run->result().truth.time_s, 41.0);
  stop_ends_it();
}

TEST_F(HeldArm, NoFaultOfTheSensorEndsIt) {
  for (const char* fault :
       {"saturated-force:time_s=40,duration_s=0.01", "silent-node:node=4,time_s=40",
        "emergency:node=4,code=0xFF00,time_s=40", "stale-force:time_s=40,duration_s=3",
        "torn-force:time_s=40,duration_s=3", "frozen-force:time_s=40,duration_s=3"}) {
    SCOPED_TRACE(fault);
    lines.all.clear();
    start({fault});
    to_catching();
    is_held(15'000);
    EXPECT_GT(run->result().truth.time_s, 41.0);
    stop_ends_it();
  }
}

TEST_F(HeldArm, WhatEndsItIsTold) {
  for (const char* fault : {"node-reset:node=1,time_s=40", "emergency:node=1,code=0x3210,time_s=40",
                            "silent-node:node=2,time_s=40"}) {
    SCOPED_TRACE(fault);
    lines.all.clear();
    start({fault});
    cycles(1500);  // in free air
    run->controller().request_stop();
    to_catching();
    cycles(20'000);
    ASSERT_TRUE(run->controller().finished());
    const WholeRun::Result result = run->result();
    EXPECT_EQ(result.ending.reason, EndReason::kBrakeFailed) << result.reason;
    EXPECT_EQ(result.ending.hold, Hold::kLost);
    EXPECT_NE(result.ending.arm_fault.kind, ArmFaultKind::kNone);
    EXPECT_NE(result.reason.find("; it was held under power, and is not any more: arm: "),
              std::string::npos)
        << result.reason;
    ASSERT_EQ(lines.all.size(), 2U);
    EXPECT_NE(lines.all[0].find("it is held under power: support it"), std::string::npos);
    EXPECT_NE(lines.all[1].find("and is not any more"), std::string::npos);
  }
}

// An arm that is in a fault holds nothing, and says nothing else.
TEST_F(HeldArm, WhereItCannotBeThatIsTold) {
  start({"emergency:node=1,code=0x3210,at=free,time_s=0.5"});
  cycles(40'000);
  ASSERT_TRUE(run->controller().finished());
  const WholeRun::Result result = run->result();
  EXPECT_EQ(result.ending.reason, EndReason::kArmFault) << result.reason;
  EXPECT_EQ(result.ending.hold, Hold::kRefused);
  EXPECT_GE(result.ending.slip.joint, 0);
  ASSERT_EQ(lines.all.size(), 1U);
  EXPECT_NE(lines.all[0].find("; it was not held under power: "), std::string::npos)
      << lines.all[0];
}

/// When a run without faults watches its brakes.
double watching_s() {
  WholeRun::Options options = with_faults({});
  options.start = std::string("4");
  WholeRun run(holding_cell(), box_task(), box_plan("4"), options);
  if (!run.prepare()) return 0.0;
  while (run.cycle() && run.controller().state() != State::kWatching) {
  }
  return run.result().truth.time_s;
}

// With the drives off, an encoder that jumps is no brake that slips.
TEST(HeldBrakes, AnEncodersJumpIsNotTakenForASlip) {
  for (const double after_s : {0.05, 0.2, 0.4}) {
    WholeRun::Options options = with_faults(
        {format("encoder-jump:node=3,jump_m=0.01,time_s=%.3f", watching_s() + after_s)});
    options.start = std::string("4");
    const auto result = WholeRun(holding_cell(), box_task(), box_plan("4"), options).run();
    EXPECT_EQ(result.ending.reason, EndReason::kEncoderJump) << after_s << ": " << result.reason;
    EXPECT_LT(result.ending.slip.joint, 0) << result.reason;
    EXPECT_EQ(result.ending.hold, Hold::kNone);
  }
}

}  // namespace
}  // namespace tenon::tests
