// Gantries with sensors that are slower than the cycle of 500 Hz: the box demo planned for each and
// executed, and what the sensor's faults are called, in time.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "executor/dry_run/plan_check.h"
#include "shared/config/load.h"
#include "sim/cell/faults/fault_spec.h"
#include "tests/support/commands.h"
#include "tests/support/places.h"
#include "tests/support/planned.h"
#include "tests/support/scratch_folder.h"
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

/// @param after a line for people where samples stay away  @param range likewise, at its end
std::vector<SensorFault> faults_of(const char* after, const char* range, SensorFault overrange) {
  return {silence("stale-force", after),
          silence("torn-force", after),
          {"frozen-force", "wrench_frozen", ""},
          {"saturated-force", "sensor_saturated", range},
          std::move(overrange)};
}

// Asked by every third SYNC.
const SensorCase kSlow{"slow_sensor_gantry3", 3,
                       faults_of(kAfter15, "sensor axis x reads 300 N, its range ends at 300",
                                 {"overrange-force", "arm_fault: sensor_invalid", "0xFF01"})};
// Robotous RFT: streams at 200 Hz by a clock of its own.
const SensorCase kRft{
    "rft_gantry3", 3,
    faults_of(kAfter15, "sensor axis x reads 200 N, its range ends at 200",
              {"overrange-force", "arm_fault: sensor_invalid", "reports overload 0x04 (fz)"})};
// ATI NETCANOEM: polled at 250 Hz.
const SensorCase kNetcanoem{"ati_gantry3", 2,
                            faults_of(kAfter10, "its range ends at 290",
                                      {"overrange-force", "sensor_saturated", "sensor axis rx"})};

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

std::string cell_file(const std::string& name) {
  return in_tree(name == "gantry3" ? "hw/cells/gantry3.yaml"
                                   : "tests/plans/" + name + "/cell.yaml");
}

// By what a user types, in worlds that are drawn for every run. The seed was fixed before any of
// these runs.
class BoxBySensor : public testing::TestWithParam<const char*> {};

TEST_P(BoxBySensor, EndsAtTheGoalInTwoHundredDrawnWorlds) {
  constexpr int kRuns = 200;
  const ScratchFolder folder;
  const std::string task = in_tree("planner/tasks/box_on_table_2d.yaml");
  const std::string plan = folder.path() / "box.tnp";
  const Ended planned = run(folder, {executable("tenon-plan"), task, "--start", "1", "--cell",
                                     cell_file(GetParam()), "-o", plan});
  ASSERT_EQ(planned.status, 0) << planned.err;
  const std::string json = folder.path() / "evaluated.json";
  const Ended evaluated =
      run(folder,
          {executable("tenon-evaluate"), "--cell", cell_file(GetParam()), "--task", task, "--plan",
           plan, "-n", std::to_string(kRuns), "--seed", "90210", "--experiment",
           in_tree("sim/experiments/box_on_table.yaml"), "--json", json},
          std::chrono::hours(1));
  ASSERT_EQ(evaluated.status, 0) << evaluated.err;
  std::printf("%s", evaluated.out.c_str());
  const auto result = nlohmann::json::parse(folder.get("evaluated.json"));
  const auto& summary = result.at("plans")[0].at("summary");
  EXPECT_EQ(summary.at("done_but_wrong").get<int>(), 0);
  EXPECT_GE(summary.at("success").at("succeeded").get<int>(), kRuns * 98 / 100);
}

INSTANTIATE_TEST_SUITE_P(Full, BoxBySensor,
                         testing::Values("gantry3", "slow_sensor_gantry3", "rft_gantry3",
                                         "ati_gantry3"),
                         [](const auto& each) { return std::string(each.param); });

// What no frame tells: the payload's weight does, where the cell knows what the sensor reads of
// itself, and before anything has moved.
class MiscalibratedSensors : public testing::TestWithParam<const char*> {};

TEST_P(MiscalibratedSensors, AnotherUnitOrMatrixIsNamedByTheTare) {
  Cell cell = load_cell(cell_file(GetParam()));
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
