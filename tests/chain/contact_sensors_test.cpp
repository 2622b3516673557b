// Gantries with sensors that are slower than the cycle of 500 Hz: the box demo planned for each and
// executed, and what the sensor's faults are called, in time.

#include <gtest/gtest.h>

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "executor/dry_run/plan_check.h"
#include "shared/config/load.h"
#include "sim/cell/faults/fault_spec.h"
#include "tests/support/places.h"
#include "tests/support/planned.h"
#include "tests/support/sensor_faults.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

struct SensorCase {
  std::string cell;  ///< a folder in tests/plans
  std::uint32_t cycles_per_sample = 1;
  std::vector<SensorFault> faults;
};

// NOLINTNEXTLINE(readability-identifier-naming): googletest's name
void PrintTo(const SensorCase& sensor, std::ostream* out) { *out << sensor.cell; }

SensorFault silence(const char* fault, const char* after) {
  return {fault, "arm_fault: sensor_stale", after};
}

// Five missing samples, of two cycles each and of three.
const char* const kAfter10 = "no new wrench in 11 cycles in a row, at most 10";
const char* const kAfter15 = "no new wrench in 16 cycles in a row, at most 15";

// Asked by every third SYNC.
const SensorCase kSlow{"slow_sensor_gantry3", 3, {silence("stale-force", kAfter15)}};
// Robotous RFT: streams at 200 Hz by a clock of its own.
const SensorCase kRft{
    "rft_gantry3",
    3,
    {silence("stale-force", kAfter15),
     silence("torn-force", kAfter15),
     {"frozen-force", "wrench_frozen", ""},
     {"saturated-force", "sensor_saturated", "sensor axis x reads 200 N, its range ends at 200"}}};
// ATI NETCANOEM: polled at 250 Hz.
const SensorCase kNetcanoem{"ati_gantry3",
                            2,
                            {silence("stale-force", kAfter10),
                             silence("torn-force", kAfter10),
                             {"frozen-force", "wrench_frozen", ""},
                             {"saturated-force", "sensor_saturated", "its range ends at 290"}}};

class ContactSensors : public testing::TestWithParam<SensorCase> {
 protected:
  const Cell cell = load_cell(in_tree("tests/plans/" + GetParam().cell + "/cell.yaml"));
};

TEST_P(ContactSensors, APlanForTheCellReachesTheGoalWhereverTheTableStands) {
  ASSERT_EQ(cell.robot.sensor.cycles_per_sample, GetParam().cycles_per_sample);
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

TEST_P(ContactSensors, EachFaultOfItEndsByItsNameInItsTime) {
  expect_sensor_faults(cell, GetParam().faults);
}

INSTANTIATE_TEST_SUITE_P(Tree, ContactSensors, testing::Values(kSlow, kRft, kNetcanoem),
                         [](const auto& each) { return each.param.cell; });

// What no frame tells: the payload's weight does, where the cell knows what the sensor reads of
// itself, and before anything has moved.
class MiscalibratedSensors : public testing::TestWithParam<const char*> {};

TEST_P(MiscalibratedSensors, AnotherUnitOrMatrixIsNamedByTheTare) {
  const std::string folder = GetParam() == std::string("gantry3")
                                 ? "hw/cells/gantry3.yaml"
                                 : "tests/plans/" + std::string(GetParam()) + "/cell.yaml";
  Cell cell = load_cell(in_tree(folder));
  cell.sensor_bias = SensorBias{.force_tolerance_N = 1.5, .torque_tolerance_Nm = 0.5};
  const auto [task, plan] = planned_box(cell, "1");
  for (const char* fault :
       {"", "wrong-units:factor=4.448", "wrong-units:factor=0.2248", "wrong-matrix"}) {
    SCOPED_TRACE(fault);
    WholeRun::Options options;
    options.start = "1";
    if (*fault != '\0') options.faults = {sim::parse_fault(fault)};
    WholeRun run(cell, task, plan, options);
    const auto result = run.run();
    if (*fault == '\0') {
      EXPECT_EQ(result.ending.reason, executor::EndReason::kPlanDone) << result.reason;
      continue;
    }
    EXPECT_EQ(result.steps, 0U) << result.reason;
    EXPECT_EQ(result.ending.reason, executor::EndReason::kTareOffset) << result.reason;
    for (const auto& drive : result.truth.drives) EXPECT_TRUE(drive.brake_engaged) << drive.joint;
  }
}

INSTANTIATE_TEST_SUITE_P(Tree, MiscalibratedSensors,
                         testing::Values("gantry3", "slow_sensor_gantry3", "rft_gantry3",
                                         "ati_gantry3"),
                         [](const auto& each) { return std::string(each.param); });

TEST(ContactWithASlowSensor, ThePlanIsSlowerByTheSensorsPeriod) {
  const Cell cell = load_cell(in_tree("tests/plans/slow_sensor_gantry3/cell.yaml"));
  const auto [task, plan] = planned_box(cell, "1");
  // 6 + 5e4 v (20 ms + M / D) within 0.8 of 60 N; without the sensor's period it were 16 ms.
  EXPECT_LT(plan.parameter_sets[0].speeds.contact_mps, 42.0 / 5e4 / 0.020);
}

}  // namespace
}  // namespace tenon::tests
