// Shipped robots on drives in the likeness of those that they name: bring-up, and a whole
// plan (matrix/ has every fault). What such a drive cannot be told is what the master says of it at
// the start.

#include "tests/support/twins.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "hw/arm/describe_fault.h"
#include "hw/arm/drive_settings.h"
#include "shared/canopen/robot_drives.h"
#include "tests/support/frame_filter.h"
#include "tests/support/planned.h"
#include "tests/support/rest_watch.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;

struct Twin {
  const char* cell;     ///< and of the file of tests/twins
  const char* plan_of;  ///< the cell that its plan was made for
};

/// A run of start 1 of the box task, with drives as the file of the cell's name says.
struct TwinRun {
  explicit TwinRun(const Twin& twin, std::vector<sim::Fault> faults = {})
      : cell(shipped_cell(twin.cell)), planned(planned_box(shipped_cell(twin.plan_of), "1")) {
    WholeRun::Options options;
    options.start = "1";
    options.offset = (Vector6() << 0.01, -0.01, 0.0, 0.0, 0.0, 0.0).finished();
    options.twins = twins_of(cell.robot, twin.cell);
    options.faults = std::move(faults);
    run = std::make_unique<WholeRun>(cell, planned.task, planned.plan, options);
  }
  [[nodiscard]] std::string fault() const { return hw::describe(run->arm().fault(), cell.robot); }

  Cell cell;
  Planned planned;
  std::unique_ptr<WholeRun> run;
};

TEST(Twins, ARobotOfDrivesByTheBookIsRefusedByTheRealOnes) {
  TwinRun twin({"epos4", "gantry3"});
  for (Joint& joint : twin.cell.robot.joints) canopen_drive(joint).profile = DriveProfile{};
  WholeRun::Options options;
  options.twins = twins_of(twin.cell.robot, "epos4");
  WholeRun run(twin.cell, twin.planned.task, twin.planned.plan, options);
  EXPECT_FALSE(run.prepare());
  EXPECT_EQ(hw::describe(run.arm().fault(), twin.cell.robot),
            "node 1 (x): refused 6066h:0 = 0xA: value too high (abort 0x06090031); check the "
            "device's manual and firmware, and the profile of its drive");
}

TEST(Twins, TheLwaComesUpOnItsOwnDrives) {
  TwinRun twin({"lwa4p", "csp6"});
  ASSERT_TRUE(twin.run->prepare()) << twin.fault();
  EXPECT_FALSE(hw::drive_remarks(twin.cell.robot).empty());
}

class TwinPlan : public ::testing::TestWithParam<Twin> {};

TEST_P(TwinPlan, GoesThroughAWholePlanAndIsLeftInItsBrakes) {
  TwinRun twin(GetParam());
  const WholeRun::Result result = twin.run->run();
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
  EXPECT_LT(result.truth.error_norm_m, twin.planned.task.goal_tolerance_m);
  RestWatch rest(twin.cell.robot);
  for (int i = 0; i < 100; ++i) {
    twin.run->leave_alone(0.01);
    rest.look(twin.run->result().truth);
  }
  EXPECT_EQ(rest.complaints(), "");
}

TEST_P(TwinPlan, AWarningOfADriveEndsNothing) {
  TwinRun twin(GetParam());
  CanBus& drive = twin.run->bus().attach();
  ASSERT_TRUE(twin.run->prepare()) << twin.fault();
  const std::uint8_t node = twin.cell.robot.joints[1].node;
  for (int i = 0; i < 2000 && twin.run->cycle(); ++i) {
    if (i % 500 == 499) (void)drive.send({0x80u + node, false, false, 8, {0x10, 0x42, 0x08}});
  }
  EXPECT_EQ(twin.run->arm().fault().kind, ArmFaultKind::kNone) << twin.fault();
  EXPECT_GE(twin.run->arm().counters().emergencies, 3u);
}

// Nothing of its boot is heard for 0.8 s after the master's reset, which falls at 0.3 s.
TEST_P(TwinPlan, ADriveThatBootsInFourFifthsOfASecondRunsOn) {
  constexpr double kUp_s = 0.3 + 0.8;
  const std::uint8_t node = shipped_cell(GetParam().cell).robot.joints[1].node;
  TwinRun twin(GetParam(),
               {{.kind = sim::FaultKind::kSilentNode, .node = node, .duration_s = kUp_s},
                {.kind = sim::FaultKind::kNodeReset, .node = node, .time_s = kUp_s + 0.001}});
  const WholeRun::Result result = twin.run->run();
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason << twin.fault();
  EXPECT_TRUE(result.truth.within_tolerance);
}

// The window that a drive is given arrives as half of it, as one that clamps would take it.
TEST_P(TwinPlan, ADriveThatClampsItsWindowRunsOn) {
  TwinRun twin(GetParam());
  const std::uint8_t node = twin.cell.robot.joints[1].node;
  std::uint32_t written = 0;
  const FrameFilter filter(twin.run->bus(), [&](CanFrame& frame, std::size_t) {
    const bool is_window = frame.id == 0x600u + node && frame.data[0] == 0x23 &&
                           frame.data[1] == 0x65 && frame.data[2] == 0x60;
    if (is_window) {
      written = frame.data[4] | static_cast<std::uint32_t>(frame.data[5]) << 8;
      frame.data[4] = static_cast<std::uint8_t>(written / 2);
      frame.data[5] = static_cast<std::uint8_t>(written / 2 >> 8);
    }
    return true;
  });
  ASSERT_TRUE(twin.run->prepare()) << twin.fault();
  ASSERT_GT(written, 0u);
  std::string told;
  for (const std::string& note : twin.run->arm().notes()) told += note + "\n";
  EXPECT_NE(told.find("6065h:0 holds"), std::string::npos) << told;
  while (twin.run->cycle()) {
  }
  const WholeRun::Result result = twin.run->result();
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
  EXPECT_TRUE(result.truth.within_tolerance);
}

std::string twin_name(const ::testing::TestParamInfo<Twin>& info) { return info.param.cell; }

INSTANTIATE_TEST_SUITE_P(Tree, TwinPlan, ::testing::Values(Twin{"epos4", "gantry3"}), twin_name);
INSTANTIATE_TEST_SUITE_P(Full, TwinPlan, ::testing::Values(Twin{"lwa4p", "lwa4p"}), twin_name);

}  // namespace
}  // namespace tenon::tests
