// No allocation in the control cycle.

#include <gtest/gtest.h>

#include <memory>

#include "executor/telemetry/recorder.h"
#include "tests/executor/bench.h"
#include "tests/support/allocation_count.h"

namespace tenon::executor {
namespace {

// Steps a bench with the counter on.
class CountedRun {
 public:
  explicit CountedRun(Bench& bench) : bench_(bench) {}
  bool step() {
    const std::uint64_t before = tests::allocation_count();
    const bool going_on = bench_.step();
    allocations_ += tests::allocation_count() - before;
    ++cycles_;
    return going_on;
  }
  [[nodiscard]] int cycles() const { return cycles_; }
  [[nodiscard]] std::uint64_t allocations() const { return allocations_; }

 private:
  Bench& bench_;
  int cycles_ = 0;
  std::uint64_t allocations_ = 0;
};

Plan long_plan() {
  Plan plan = hand_made_plan();
  for (int i = 0; i < 10; ++i) {
    const bool forth = i % 2 == 0;
    plan.steps.push_back(hand_made_step(1, forth ? 0.15 : -0.15,
                                        {{Outcome::kReached, static_cast<Successor>(i + 1)}}));
  }
  plan.steps.push_back(hand_made_step(0, 0.05, {{Outcome::kContact, kSuccessorDone}}));
  return plan;
}

TEST(Allocation, TheCounterCounts) {
  const std::uint64_t before = tests::allocation_count();
  const auto something = std::make_unique<int>(1);
  EXPECT_EQ(*something, 1);
  EXPECT_GT(tests::allocation_count(), before);
}

TEST(Allocation, TenThousandCyclesAndThePlansEndAllocateNothing) {
  const auto recorder = std::make_unique<Recorder>();
  Bench bench(long_plan(), {}, hand_made_cell(), Vector3::Zero(), recorder.get());
  bench.arm.walls.push_back({0, +1, 0.13});
  bench.arm.noise_N = 0.1;
  CountedRun run(bench);
  while (run.step()) {
    if (run.cycles() % 1000 == 0) recorder->drain();
  }
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanDone) << bench.ending();
  EXPECT_GE(run.cycles(), 10'000);
  EXPECT_EQ(run.allocations(), 0U);
}

TEST(Allocation, AStopAndEveryKindOfFaultAllocateNothing) {
  for (int kind = 0; kind < 5; ++kind) {
    const auto recorder = std::make_unique<Recorder>();
    Bench bench(long_plan(), {}, hand_made_cell(), Vector3::Zero(), recorder.get());
    CountedRun run(bench);
    while (run.step()) {
      if (run.cycles() != 600) continue;
      if (kind == 0) bench.controller.request_stop();
      if (kind == 1) bench.arm.push[2] = 90.0;
      if (kind == 2) bench.arm.break_with.kind = ArmFaultKind::kHeartbeatLost;
      if (kind == 3) bench.arm.mute_joints = 1;
      if (kind == 4) bench.arm.bias[0] = 300.0;
    }
    EXPECT_NE(bench.controller.ending().reason, EndReason::kPlanDone);
    EXPECT_EQ(run.allocations(), 0U) << kind;
  }
}

}  // namespace
}  // namespace tenon::executor
