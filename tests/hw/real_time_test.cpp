// The cyclic functions allocate nothing, whatever happens on the bus.

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "hw/arm/canopen_arm.h"
#include "hw/can/recording_bus.h"
#include "tests/hw/gantry_on_bus.h"
#include "tests/support/allocation_count.h"

namespace tenon::hw {
namespace {

TEST(RealTime, AllocationsAreSeenByTheCounter) {
  const std::uint64_t before = tests::allocation_count();
  const auto memory = std::make_unique<std::vector<int>>(100);
  EXPECT_GT(tests::allocation_count(), before);
}

TEST(RealTime, TenThousandCyclesWithFaultsAllocateNothing) {
  GantryOnBus gantry;
  const auto ring = std::make_unique<CanRecordRing>();
  RecordingBus recording(gantry.master, *ring);
  CanopenArm arm(gantry.robot, recording);
  ArmFeedback feedback;
  const auto prepare = [&] {
    for (int i = 0; i < 5000 && !arm.prepare(gantry.now_ns); ++i) {
      gantry.step_nodes();
      gantry.now_ns += 1'000'000;
    }
  };
  prepare();
  ASSERT_EQ(arm.state(), ArmState::kDisabled);

  std::uint64_t allocated = 0;
  int faults = 0;
  for (int cycle = 0; cycle < 10'000; ++cycle) {
    const bool stop = cycle % 1000 > 900;
    if (cycle == 3100) gantry.nodes[0]->send(0x081, {0x11, 0x86, 1, 0, 0, 0, 0, 0});
    if (cycle == 6100) gantry.nodes[3]->tears = true;
    if (cycle == 6110) gantry.nodes[3]->tears = false;
    if (cycle % 7 == 0) gantry.nodes[1]->send(0x123, {1, 2, 3});  // nobody's frame

    std::uint64_t before = tests::allocation_count();
    arm.start_cycle(gantry.now_ns);
    allocated += tests::allocation_count() - before;
    gantry.step_nodes();
    before = tests::allocation_count();
    (void)arm.receive(gantry.now_ns, feedback);
    arm.command(gantry.now_ns, stop ? ArmRequest::kDisabled : ArmRequest::kEnabled,
                feedback.position);
    allocated += tests::allocation_count() - before;
    gantry.now_ns += 2'000'000;
    if (arm.state() == ArmState::kFault) {
      ++faults;
      prepare();
    }
  }
  EXPECT_EQ(allocated, 0u);
  EXPECT_EQ(faults, 2);
  EXPECT_EQ(arm.counters().unexpected_frames, 10'000u / 7 + 1);
}

}  // namespace
}  // namespace tenon::hw
