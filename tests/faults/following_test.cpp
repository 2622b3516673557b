// A drive that stands still under power and says that all is well: nobody on the bus tells, the
// executor compares. The truth is the virtual arm's.

#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "tests/support/faulty_options.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;

// The plan for start 1 moves in x and y; which axis is frozen is named by its node.
TEST(Following, AFrozenDriveIsNamedByItsNode) {
  for (const int node : {1, 2}) {
    const std::string spec = "frozen-drive:node=" + std::to_string(node) + ",time_s=1.5";
    const auto result =
        WholeRun(gantry_cell(), box_task(), box_plan("1"), with_faults({spec})).run();
    EXPECT_EQ(result.ending.reason, EndReason::kFollowingError) << spec << ": " << result.reason;
    EXPECT_EQ(result.ending.index, node - 1);
    EXPECT_EQ(result.reason.rfind("node " + std::to_string(node) + " (", 0), 0U) << result.reason;
    EXPECT_NE(result.reason.find("it does not follow"), std::string::npos) << result.reason;
    for (const auto& drive : result.truth.drives) EXPECT_TRUE(drive.brake_engaged) << drive.joint;
  }
}

TEST(Following, OneThatFreezesForAMomentIsRiddenOut) {
  const auto result = WholeRun(gantry_cell(), box_task(), box_plan("1"),
                               with_faults({"frozen-drive:node=1,time_s=4,duration_s=0.01"}))
                          .run();
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
}

// For a second, and then its servo makes up for all of it at once: where that is felt before the
// joint is too far off, the force's line says whose drive it was.
TEST(Following, AForceThatComesOfAJointBehindSaysWhose) {
  const Cell cell = shipped_cell("csp6");
  const auto [task, plan] = planned_box(cell, "1");
  for (const int node : {1, 2, 3, 4, 5, 6}) {
    const std::string spec = "frozen-drive:node=" + std::to_string(node) + ",at=free,duration_s=1";
    const auto result = WholeRun(cell, task, plan, with_faults({spec})).run();
    std::printf("%s: %s\n", spec.c_str(), result.reason.c_str());
    if (result.ending.reason == EndReason::kPlanDone) continue;
    EXPECT_NE(result.reason.find("node " + std::to_string(node) + " ("), std::string::npos)
        << spec << ": " << result.reason;
  }
}

// Where all joints are on their way, none is accused.
TEST(Following, AForceThatNoJointLagsForNamesNone) {
  for (const char* name : {"gantry3", "csp6"}) {
    const Cell cell = shipped_cell(name);
    const auto [task, plan] = planned_box(cell, "1");
    for (const char* phase : {"free", "contact", "sliding"}) {
      const std::string spec = std::string("forged-force:force_N=80,at=") + phase;
      const auto result = WholeRun(cell, task, plan, with_faults({spec})).run();
      EXPECT_EQ(result.ending.reason, EndReason::kForceFault) << result.reason;
      EXPECT_EQ(result.ending.laggard, -1) << name << " " << spec << ": " << result.reason;
    }
  }
}

}  // namespace
}  // namespace tenon::tests
