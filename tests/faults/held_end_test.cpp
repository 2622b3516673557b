// A plan is done where its tool was told to be, and stays there until its brakes hold: what a drive
// may stay behind in motion is more than a goal allows. The truth is the virtual arm's.

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "shared/base/text.h"
#include "tests/support/faulty_options.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;

struct Faint {
  const char* cell = "";
  const char* start = "";
  const char* spec = "";  ///< in the plan's last step, but for when
};

constexpr Faint kFaint[] = {
    {"gantry3", "4", "torque-loss:node=3,share=0.1"},
    {"gantry3", "4", "torque-loss:node=1,share=0"},
    {"gantry3", "4", "frozen-drive:node=1,duration_s=100"},
    {"csp6", "1", "frozen-drive:node=1,duration_s=100"},
};

// Faults too faint for the drive's following error, from the last step's middle to after its end.
TEST(HeldEnd, WhatADriveDoesLastIsNeverDoneAndWrong) {
  int not_held = 0;
  for (const Faint& faint : kFaint) {
    const Cell cell = shipped_cell(faint.cell);
    const auto [task, plan] = planned_box(cell, faint.start);
    for (double time_s = 1.9; time_s < 3.2; time_s += 0.15) {
      const std::string spec =
          std::string(faint.spec) +
          format(",at=step:%d,time_s=%.3f", static_cast<int>(plan.steps.size()) - 1, time_s);
      WholeRun::Options options = with_faults({spec});
      options.start = faint.start;
      options.offset[0] = 0.01;
      options.offset[1] = -0.01;
      const auto result = WholeRun(cell, task, plan, options).run();
      not_held += result.ending.reason == EndReason::kNotHeld ? 1 : 0;
      if (result.ending.reason != EndReason::kPlanDone) continue;
      EXPECT_TRUE(result.truth.within_tolerance)
          << faint.cell << " " << spec << ": done, and off by " << result.truth.error_norm_m;
    }
  }
  std::printf("%d of them were not_held\n", not_held);
  EXPECT_GE(not_held, 4);
}

}  // namespace
}  // namespace tenon::tests
