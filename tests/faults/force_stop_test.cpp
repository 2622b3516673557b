// A force beyond the cell's fault in a whole run: one frame stops the drives before the cycle has
// its answers, the next cycle names it, and drives that would go on do not.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/faulty_options.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;

constexpr std::uint32_t kForceId = 0x181;
constexpr std::uint32_t kStopId = 0x183;

void expect_stopped(const std::string& robot, const std::string& more) {
  const Cell cell = shipped_cell(robot);
  const Planned planned = planned_box(cell, "1");
  std::vector<std::string> specs = {"forged-force:at=free,time_s=0.1,force_N=80,duration_s=0.002"};
  if (!more.empty()) specs.push_back(more);
  WholeRun run(cell, planned.task, planned.plan, with_faults(specs));
  std::int64_t force_ns = 0;
  std::int64_t way_ns = 0;
  int stops = 0;
  run.bus().set_observer([&](const sim::VirtualBus::Transmission& sent) {
    if (sent.frame.id == kForceId) force_ns = sent.end_ns;
    if (sent.frame.id != kStopId) return;
    ++stops;
    way_ns = sent.end_ns - force_ns;
    EXPECT_EQ(sent.frame.length, 2);
    EXPECT_EQ(sent.frame.data[0], 0x02);
  });
  const auto result = run.run();
  EXPECT_EQ(result.ending.reason, EndReason::kForceFault) << robot << ": " << result.reason;
  EXPECT_EQ(stops, 1);
  EXPECT_GT(way_ns, 0);
  EXPECT_LE(way_ns, 350'000);
  for (const auto& drive : result.truth.drives) {
    EXPECT_TRUE(drive.brake_engaged) << robot << ", " << drive.joint;
    EXPECT_EQ(drive.state, "switch on disabled") << robot << ", " << drive.joint;
  }
}

TEST(ForceStopInARun, OneFrameStopsAllDrivesAndTheRunIsNamedForTheForce) {
  for (const char* robot : {"gantry3", "csp6"}) expect_stopped(robot, "");
}

TEST(ForceStopInARun, ADriveThatResumesOnAnOldWordFindsNone) {
  expect_stopped("gantry3", "resumes-stop:node=1");
}

}  // namespace
}  // namespace tenon::tests
