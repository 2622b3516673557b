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
  // From the step's beginning.
  double first_s = 0.0;
  double last_s = 0.0;
  double every_s = 0.0;
};

constexpr Faint kFaint[] = {
    {"gantry3", "4", "torque-loss:node=3,share=0.1", 1.9, 3.2, 0.15},
    {"gantry3", "4", "torque-loss:node=1,share=0", 2.76, 3.2, 0.02},
    {"gantry3", "4", "frozen-drive:node=1,duration_s=100", 2.7, 3.0, 0.015},
    {"csp6", "1", "frozen-drive:node=1,duration_s=100", 1.9, 3.2, 0.15},
};

struct Count {
  int not_held = 0;
  int wrong = 0;  ///< done, and beyond the goal's tolerance
};

/// The fault once and again, towards the last step's end and after it.
Count struck(const Faint& faint, const executor::FaultMask& masked) {
  const Cell cell = shipped_cell(faint.cell);
  const auto [task, plan] = planned_box(cell, faint.start);
  Count count;
  for (double time_s = faint.first_s; time_s < faint.last_s && count.wrong == 0;
       time_s += faint.every_s) {
    const std::string spec =
        std::string(faint.spec) +
        format(",at=step:%d,time_s=%.3f", static_cast<int>(plan.steps.size()) - 1, time_s);
    WholeRun::Options options = with_faults({spec});
    options.start = faint.start;
    options.offset[0] = 0.01;
    options.offset[1] = -0.01;
    options.controller.masked = masked;
    const auto result = WholeRun(cell, task, plan, options).run();
    count.not_held += result.ending.reason == EndReason::kNotHeld ? 1 : 0;
    const bool done = result.ending.reason == EndReason::kPlanDone;
    count.wrong += done && !result.truth.within_tolerance ? 1 : 0;
  }
  return count;
}

// Too faint for the drive's following error.
TEST(HeldEnd, WhatADriveDoesLastIsNeverDoneAndWrong) {
  int not_held = 0;
  for (const Faint& faint : kFaint) {
    const Count count = struck(faint, {});
    not_held += count.not_held;
    EXPECT_EQ(count.wrong, 0) << faint.cell << " " << faint.spec;
  }
  std::printf("%d of them were not_held\n", not_held);
  EXPECT_GE(not_held, 4);
}

TEST(HeldEnd, WithoutItsDetectorItIs) {
  executor::FaultMask masked;
  masked.mask(EndReason::kNotHeld);
  for (const Faint& faint : kFaint) {
    EXPECT_GT(struck(faint, masked).wrong, 0) << faint.cell << " " << faint.spec;
  }
}

}  // namespace
}  // namespace tenon::tests
