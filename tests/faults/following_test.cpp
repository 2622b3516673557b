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

}  // namespace
}  // namespace tenon::tests
