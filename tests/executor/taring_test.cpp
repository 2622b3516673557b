// A zero that moves while it is found: one that comes to rest is waited for, one that does not is
// named.

#include <gtest/gtest.h>

#include <cmath>

#include "executor/faults/fault_table.h"
#include "executor/loop/controller.h"
#include "executor/sensing/unnoticed.h"
#include "tests/executor/bench.h"

namespace tenon::executor {
namespace {

/// Moves the sensor's zero by `rate_Nps`, which falls off with `time_constant_s`, from the tare on.
void creep(Bench& bench, double rate_Nps, double time_constant_s) {
  bench.run_until(State::kTaring);
  double rate = rate_Nps;
  for (int i = 0; i < 2000 && bench.controller.state() == State::kTaring; ++i) {
    bench.arm.bias[1] += 2e-3 * rate;
    rate *= std::exp(-2e-3 / time_constant_s);
    ASSERT_TRUE(bench.step());
  }
}

// 3 N/s, falling off in 0.3 s: the first tare's halves differ by 0.32 N, of 0.25 that noise may
// make, the second's by 0.08 N.
TEST(Taring, AZeroThatCreepsAtFirstIsWaitedFor) {
  Bench bench(touch_and_slide_plan());
  bench.arm.walls.push_back({0, +1, 0.13});
  creep(bench, 3.0, 0.3);
  EXPECT_EQ(bench.controller.state(), State::kRunning) << bench.ending();
  bench.run();
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanDone) << bench.ending();
}

TEST(Taring, AZeroThatGoesOnMovingIsNamedWithinItsBound) {
  Bench bench(touch_and_slide_plan());
  creep(bench, 3.0, 1e6);
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kTareDrift) << bench.ending();
  EXPECT_EQ(bench.controller.ending().index, 1);
  std::int64_t tared = 0;
  for (const CycleRecord& record : bench.keeper.records) tared += record.state == State::kTaring;
  const FaultRow* row = fault_row(EndReason::kTareDrift);
  ASSERT_NE(row, nullptr);
  EXPECT_LE(tared, bound_cycles(*row, bench.controller.cell().robot).value());
  EXPECT_GT(tared, 4 * kTareSamples);
}

TEST(Taring, ACellThatKnowsNoBiasIsToldWhatNobodyNotices) {
  Cell cell = hand_made_cell();
  cell.sensor_bias.reset();
  EXPECT_NE(unnoticed_while_taring(cell).find("has no sensor_bias: nobody notices what pushes"),
            std::string::npos);
  cell.sensor_bias.emplace();
  EXPECT_EQ(unnoticed_while_taring(cell), "");
  cell.sensor_bias.reset();
  cell.joint_torque.emplace();
  EXPECT_EQ(unnoticed_while_taring(cell), "") << "no sensor";
}

}  // namespace
}  // namespace tenon::executor
