// A gantry with a sensor on an ATI NETCANOEM board, polled at 250 Hz in a cycle of 500 Hz: the box
// demo planned for it and executed, and what its faults are called, in time.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "executor/dry_run/plan_check.h"
#include "shared/config/load.h"
#include "tests/support/places.h"
#include "tests/support/planned.h"
#include "tests/support/sensor_faults.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

Cell ati_cell() { return load_cell(in_tree("tests/plans/ati_gantry3/cell.yaml")); }

TEST(ContactWithANetcanoem, APlanForTheCellReachesTheGoalWhereverTheTableStands) {
  const Cell cell = ati_cell();
  ASSERT_EQ(cell.robot.sensor.cycles_per_sample, 2);
  const Start& start = box_start("1");
  const auto [task, plan] = planned_box(cell, start.name);
  EXPECT_TRUE(executor::check_plan(plan, cell).empty());
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    double distance = 0.0;
    WholeRun::Options run_options;
    run_options.start = start.name;
    run_options.seed = seed;
    run_options.offset = draw_offset(task, start, seed, distance);
    WholeRun run(cell, task, plan, run_options);
    const auto result = run.run();
    EXPECT_EQ(result.ending.reason, executor::EndReason::kPlanDone)
        << "seed " << seed << " at " << distance << " sigma: " << result.reason;
    EXPECT_LT(result.truth.error_norm_m, task.goal_tolerance_m) << "seed " << seed;
    EXPECT_LE(result.truth.contact_force_N_max, 0.8 * cell.force_fault_N) << "seed " << seed;
    EXPECT_EQ(run.arm().counters().wrenches_missing, 0U) << "seed " << seed;
    EXPECT_EQ(run.arm().counters().wrench_halves_torn, 0U) << "seed " << seed;
    EXPECT_EQ(run.arm().counters().late_frames, 0U) << "seed " << seed;
  }
}

TEST(ContactWithANetcanoem, EachFaultOfItEndsByItsNameInItsTime) {
  const Cell cell = ati_cell();
  expect_sensor_faults(cell, {{"stale-force", "arm_fault: sensor_stale",
                               "no new wrench in 11 cycles in a row, at most 10"},
                              {"torn-force", "arm_fault: sensor_stale",
                               "no new wrench in 11 cycles in a row, at most 10"},
                              {"frozen-force", "wrench_frozen", ""},
                              {"saturated-force", "sensor_saturated", "its range ends at 290"}});
}

}  // namespace
}  // namespace tenon::tests
