// Arm and sensor on a bus each: whole plans in lockstep, whatever the sensor speaks and whatever
// identifiers it shares with the arm, and what happens when one of the two buses goes away.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "shared/config/load.h"
#include "shared/sensors/ati_netcanoem.h"
#include "tests/support/places.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;
using executor::State;

struct ApartCase {
  std::string name;
  std::string cell;
  std::uint32_t sensor_bitrate_bps = 1'000'000;
  std::uint32_t ati_base = 0;  ///< of an ATI sensor; 0: as its file has it
};

// NOLINTNEXTLINE(readability-identifier-naming): googletest's name
void PrintTo(const ApartCase& apart, std::ostream* out) { *out << apart.name; }

Cell with_own_bus(const ApartCase& apart) {
  const std::string in_tests = "tests/plans/" + apart.cell + "/cell.yaml";
  const bool shipped = apart.cell == "gantry3" || apart.cell == "mit6";
  Cell cell = load_cell(in_tree(shipped ? "hw/cells/" + apart.cell + ".yaml" : in_tests));
  ForceTorqueSensor& sensor = cell.robot.sensor;
  sensor.own_bitrate_bps = apart.sensor_bitrate_bps;
  if (apart.ati_base != 0) {
    sensor.request_id = apart.ati_base * ati::kOperations;
    sensor.sample_ids = {sensor.request_id | ati::kReadGauges,
                         sensor.request_id | ati::kGaugesSecond};
  }
  return cell;
}

class TwoBuses : public testing::TestWithParam<ApartCase> {
 protected:
  TwoBuses() {
    options.start = "1";
    options.offset[0] = 0.02;
    options.offset[1] = 0.015;
  }

  const Cell cell = with_own_bus(GetParam());
  const Plan plan = load_plan(shared_plan("box_1_" + GetParam().cell));
  WholeRun::Options options;
};

TEST_P(TwoBuses, AWholePlanRuns) {
  WholeRun run(cell, box_task(), plan, options);
  const auto result = run.run();
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
  EXPECT_LT(result.truth.error_norm_m, box_task().goal_tolerance_m);
  EXPECT_EQ(run.arm().counters().unexpected_frames, 0U);
  EXPECT_EQ(run.arm().counters().wrenches_missing, 0U);
  EXPECT_GT(run.sensor_bus().statistics().frames, result.cycles / 3U) << "the sensor was there";
}

/// What ends a run when a bus goes down in mid-motion. The drives stand in the end, and their
/// brakes hold where they have any.
std::string taken_down(WholeRun& run, bool sensors) {
  if (!run.prepare()) return "not ready: " + run.result().reason;
  for (int moving = 0; moving < 200;) {
    if (!run.cycle()) return "ended before: " + run.result().reason;
    moving += run.controller().state() == State::kRunning ? 1 : 0;
  }
  (sensors ? run.sensor_bus() : run.bus()).set_up(false);
  const std::int64_t before_ns = run.now_ns();
  while (run.cycle()) {
  }
  EXPECT_LT(run.now_ns() - before_ns, 5'000'000'000) << "and that soon";
  run.leave_alone(2.0);
  EXPECT_TRUE(run.cell().at_standstill());
  EXPECT_EQ(run.controller().ending().reason, EndReason::kArmFault);
  return run.result().reason;
}

TEST_P(TwoBuses, TheArmsGoneIsNamedAndTheDrivesStopByThemselves) {
  WholeRun run(cell, box_task(), plan, options);
  const std::string reason = taken_down(run, false);
  EXPECT_NE(reason.find("the CAN bus of the arm is gone"), std::string::npos) << reason;
}

TEST_P(TwoBuses, TheSensorsGoneIsNamedAndTheArmIsStopped) {
  WholeRun run(cell, box_task(), plan, options);
  const std::string reason = taken_down(run, true);
  EXPECT_NE(reason.find("the CAN bus of the force/torque sensor is gone"), std::string::npos)
      << reason;
  for (const auto& drive : run.cell().truth().drives) {
    EXPECT_EQ(drive.brake_engaged, cell.robot.brakes) << drive.joint;
  }
}

// A sensor of 250 kbit/s beside an arm of 1 Mbit/s; polled ones that have the identifiers of the
// drives' feedback, of their commands, and of SYNC.
INSTANTIATE_TEST_SUITE_P(Tree, TwoBuses,
                         testing::Values(ApartCase{"node", "gantry3"},
                                         ApartCase{"slow_bus", "gantry3", 250'000},
                                         ApartCase{"motors", "mit6"},
                                         ApartCase{"rft", "rft_gantry3"},
                                         ApartCase{"ati", "ati_gantry3"},
                                         ApartCase{"ati_as_feedback", "ati_gantry3", 500'000, 0x19},
                                         ApartCase{"ati_as_command", "ati_gantry3", 500'000, 0x20},
                                         ApartCase{"ati_as_sync", "ati_gantry3", 500'000, 0x08}),
                         [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace tenon::tests
