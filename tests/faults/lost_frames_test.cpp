// What lost frames cost a plan's accuracy. Drives that miss a setpoint or a SYNC stop and go, and
// the sensor feels the payload's jolt; guarded moves probe for contacts that are none.

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <string>

#include "executor/loop/cycle_runner.h"
#include "sim/cell/faults/fault_spec.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

// Of the shorter plan: lost for longer at that rate, so many cycles come to lack an answer that the
// run is stopped for it.
constexpr const char* kStart = "4";

struct Execution {
  WholeRun::Result result;
  std::int64_t incomplete_cycles = 0;
  int probes = 0;
};

/// Counts the guarded moves' probes.
class ProbeCount final : public executor::CycleSink {
 public:
  void record(const executor::CycleRecord& record) noexcept override {
    const bool probing = record.moving && record.phase == GuardedMove::Phase::kProbing;
    count_ += probing && !probing_;
    probing_ = probing;
  }
  [[nodiscard]] int count() const { return count_; }

 private:
  int count_ = 0;
  bool probing_ = false;
};

Execution run_with(std::uint64_t seed, const std::string& fault) {
  WholeRun::Options options;
  options.start = kStart;
  options.seed = seed;
  options.offset[0] = 0.01;
  options.offset[1] = -0.01;
  if (!fault.empty()) options.faults.push_back(sim::parse_fault(fault));
  ProbeCount probes;
  WholeRun lockstep(gantry_cell(), box_task(), box_plan(kStart), options, &probes);
  Execution run;
  run.result = lockstep.run();
  run.incomplete_cycles = lockstep.statistics().incomplete_cycles;
  run.probes = probes.count();
  return run;
}

TEST(LostFrames, OneInFiveHundredCostsAtMostATenthOfAMillimetre) {
  for (const char* fault : {"drop:time_s=3,duration_s=100,probability=0.002,seed=",
                            "delay:node=127,time_s=3,duration_s=100,delay_s=0.003,"
                            "probability=0.002,seed="}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const Execution clean = run_with(seed, "");
      const Execution lossy = run_with(seed, fault + std::to_string(seed));
      for (const Execution* run : {&clean, &lossy}) {
        ASSERT_EQ(run->result.ending.reason, executor::EndReason::kPlanDone) << run->result.reason;
      }
      EXPECT_GT(lossy.probes, clean.probes) << "nothing was put to the test";
      const Vector3 off_m = lossy.result.truth.tool.position_m - clean.result.truth.tool.position_m;
      std::printf("%s%d: %d cycles incomplete, %d probes for %d, %.3f mm from the run without\n",
                  fault, static_cast<int>(seed), static_cast<int>(lossy.incomplete_cycles),
                  lossy.probes, clean.probes, 1e3 * off_m.norm());
      EXPECT_LT(off_m.norm(), 0.1e-3);
    }
  }
}

}  // namespace
}  // namespace tenon::tests
