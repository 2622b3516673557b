// What stops leave behind under the settings that the master writes: on drives by the book no arm
// is powered and none drops, however the run ends; what a drive cannot do that does less than its
// standard says ends by name. The truth is the virtual arm's.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/faulty_options.h"
#include "tests/support/planned.h"
#include "tests/support/rest_watch.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;
using executor::State;

/// Start 1 of the box task on a cell, with drives as `specs` say.
class Stop {
 public:
  explicit Stop(const std::string& cell_name, const std::vector<std::string>& specs = {})
      : cell(shipped_cell(cell_name)),
        planned(planned_box(cell, "1")),
        run(cell, planned.task, planned.plan, with_faults(specs)),
        rest(cell.robot) {
    EXPECT_TRUE(run.prepare());
  }

  /// Moving, by the executor's clock.
  void until_s(double time_s) {
    while (run.now_ns() < static_cast<std::int64_t>(1e9 * time_s)) ASSERT_TRUE(run.cycle());
    ASSERT_EQ(run.controller().state(), State::kRunning);
  }
  void to_the_end() {
    bool more = true;
    while (more) {
      more = run.cycle();
      if (run.controller().state() >= State::kHolding) rest.look(run.result().truth);
    }
    leave_alone();
  }
  /// The executor is gone. More than a heartbeat's timeout, the longest ramp and a brake.
  void leave_alone() {
    for (int i = 0; i < 1000; ++i) {
      run.leave_alone(0.001);
      rest.look(run.result().truth);
    }
  }
  [[nodiscard]] const executor::Ending& ending() { return run.controller().ending(); }

  Cell cell;
  Planned planned;
  WholeRun run;
  RestWatch rest;
};

class ByTheBook : public ::testing::TestWithParam<const char*> {};

TEST_P(ByTheBook, ThePlansEndLeavesNoPowerAndDropsNothing) {
  Stop stop(GetParam());
  stop.to_the_end();
  EXPECT_EQ(stop.ending().reason, EndReason::kPlanDone);
  EXPECT_EQ(stop.rest.complaints(), "");
}

TEST_P(ByTheBook, TheUsersStopLeavesNoPowerAndDropsNothing) {
  Stop stop(GetParam());
  stop.until_s(2.5);
  stop.run.controller().request_stop();
  stop.to_the_end();
  EXPECT_EQ(stop.ending().reason, EndReason::kStopRequested);
  EXPECT_EQ(stop.rest.complaints(), "");
}

TEST_P(ByTheBook, AQuickStopInMotionLeavesNoPowerAndDropsNothing) {
  const Cell cell = shipped_cell(GetParam());
  const std::string sensor = std::to_string(cell.robot.sensor.node);
  Stop stop(GetParam(), {"silent-node:node=" + sensor + ",time_s=2.5"});
  stop.to_the_end();
  EXPECT_EQ(stop.ending().reason, EndReason::kArmFault);
  EXPECT_EQ(stop.rest.complaints(), "");
}

TEST_P(ByTheBook, ADeadExecutorLeavesNoPowerAndDropsNothing) {
  for (const double time_s : {2.5, 4.0, 6.0}) {
    Stop stop(GetParam());
    stop.until_s(time_s);
    stop.leave_alone();
    EXPECT_EQ(stop.rest.complaints(), "") << time_s;
  }
}

// Suspended and let go on: the drives have stopped by themselves, and have left operational.
TEST_P(ByTheBook, AnExecutorThatStoodStillSeesTheDrivesOffAndTheBrakesHold) {
  Stop stop(GetParam());
  stop.until_s(2.5);
  stop.run.leave_alone(3.0);
  stop.to_the_end();
  EXPECT_EQ(stop.ending().reason, EndReason::kArmFault) << stop.run.result().reason;
  EXPECT_TRUE(stop.ending().disable_confirmed) << stop.run.result().reason;
  EXPECT_EQ(stop.ending().brakes_unwatched, 0U) << stop.run.result().reason;
  EXPECT_EQ(stop.rest.complaints(), "");
}

INSTANTIATE_TEST_SUITE_P(Cells, ByTheBook, ::testing::Values("gantry3", "csp6"));

TEST(UnkindDrives, OneThatKeepsPowerHoldsItsAxisAndIsAloneInThat) {
  Stop stop("gantry3", {"keeps-power:node=3"});
  stop.until_s(2.5);
  stop.leave_alone();
  EXPECT_EQ(stop.rest.complaints(), "z: quick stop active, brake off, slipped by 0");
  const double height_m = stop.run.result().truth.drives[2].position;
  stop.run.leave_alone(2.0);
  EXPECT_NEAR(stop.run.result().truth.drives[2].position, height_m, 1e-5) << "it is held";
}

// A drive by the book knows how long its brake takes, and holds until then.
TEST(UnkindDrives, ABrakeSlowerThanItsDriveKnowsLetsTheAxisSlipAndIsNamed) {
  Stop stop("gantry3", {"slow-brake:node=3,brake_s=0.05"});
  stop.until_s(2.5);
  stop.run.controller().request_stop();
  stop.to_the_end();
  EXPECT_EQ(stop.ending().reason, EndReason::kBrakeFailed);
  EXPECT_EQ(stop.ending().index, 2);
  EXPECT_TRUE(stop.rest.off());
  EXPECT_FALSE(stop.rest.held());
}

TEST(UnkindDrives, OneThatResumesFromAQuickStopIsStoppedAgain) {
  for (const char* cell : {"gantry3", "csp6"}) {
    const std::string sensor = std::to_string(shipped_cell(cell).robot.sensor.node);
    Stop stop(cell, {"resumes-stop:node=1", "silent-node:node=" + sensor + ",time_s=2.5"});
    stop.to_the_end();
    EXPECT_EQ(stop.ending().reason, EndReason::kArmFault) << cell;
    EXPECT_EQ(stop.ending().arm_fault.kind, ArmFaultKind::kSensorStale) << cell;
    EXPECT_EQ(stop.rest.complaints(), "") << cell;
  }
}

}  // namespace
}  // namespace tenon::tests
