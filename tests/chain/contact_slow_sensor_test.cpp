// A force/torque sensor three times slower than the cycle: planned for, executed, and missed.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "executor/dry_run/plan_check.h"
#include "executor/faults/fault_table.h"
#include "shared/config/load.h"
#include "sim/cell/faults/fault_spec.h"
#include "tests/support/places.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

Cell slow_sensor_cell() { return load_cell(in_tree("tests/plans/slow_sensor_gantry3/cell.yaml")); }

TEST(ContactWithASlowSensor, APlanForTheCellReachesTheGoalWhereverTheTableStands) {
  const Cell cell = slow_sensor_cell();
  const Start& start = box_start("1");
  const auto [task, plan] = planned_box(cell, start.name);
  EXPECT_TRUE(executor::check_plan(plan, cell).empty());
  // 6 + 5e4 v (20 ms + M / D) within 0.8 of 60 N; without the sensor's period it were 16 ms.
  EXPECT_LT(plan.parameter_sets[0].speeds.contact_mps, 42.0 / 5e4 / 0.020);

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
  }
}

TEST(ContactWithASlowSensor, ItsSilenceIsNamedAfterFiveMissingSamples) {
  const Cell cell = slow_sensor_cell();
  const auto [task, plan] = planned_box(cell, "1");
  WholeRun::Options run_options;
  run_options.start = "1";
  run_options.faults = {sim::parse_fault("stale-force:time_s=4")};
  const auto result = WholeRun(cell, task, plan, run_options).run();
  EXPECT_EQ(result.ending.reason, executor::EndReason::kArmFault);
  EXPECT_EQ(result.ending.arm_fault.kind, ArmFaultKind::kSensorStale) << result.reason;
  EXPECT_NE(result.reason.find("no new wrench in 16 cycles in a row, at most 15"),
            std::string::npos)
      << result.reason;
  for (const auto& drive : result.truth.drives) EXPECT_TRUE(drive.brake_engaged) << drive.joint;
}

}  // namespace
}  // namespace tenon::tests
