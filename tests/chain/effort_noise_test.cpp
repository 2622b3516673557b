// What drives report of their efforts has noise: a run whose efforts tell the force is the same for
// the same seed, and done with it as with coarse drives that have none.

#include <gtest/gtest.h>

#include <bit>
#include <string>
#include <utility>
#include <vector>

#include "executor/record/cycle_record.h"
#include "executor/record/cycle_sink.h"
#include "shared/config/load.h"
#include "tests/support/places.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

class Kept final : public executor::CycleSink {
 public:
  void record(const executor::CycleRecord& r) noexcept override { records.push_back(r); }
  std::vector<executor::CycleRecord> records;
};

struct Seen {
  WholeRun::Result result;
  std::vector<executor::CycleRecord> records;
};

Seen run_with(const Cell& cell, const Cell& planned_for, double noise_permille,
              std::uint64_t seed) {
  const Planned planned = planned_box(planned_for, "1");
  Kept kept;
  WholeRun::Options options;
  options.start = "1";
  options.seed = seed;
  options.offset << 0.01, 0.01, 0.0, 0.0, 0.0, 0.0;
  options.effort_noise_permille = noise_permille;
  WholeRun run(cell, planned.task, planned.plan, options, &kept);
  WholeRun::Result result = run.run();
  return {std::move(result), std::move(kept.records)};
}

/// To the bit.
bool same(const executor::CycleRecord& a, const executor::CycleRecord& b) {
  const auto bits = [](const auto& values) {
    std::vector<std::uint64_t> all;
    for (const double value : values) all.push_back(std::bit_cast<std::uint64_t>(value));
    return all;
  };
  return a.state == b.state && a.arm_state == b.arm_state && a.time_ns == b.time_ns &&
         a.wrench_fresh == b.wrench_fresh && bits(a.position) == bits(b.position) &&
         bits(a.position_commanded) == bits(b.position_commanded) &&
         bits(a.wrench_raw) == bits(b.wrench_raw) && bits(a.wrench) == bits(b.wrench) &&
         bits(a.velocity) == bits(b.velocity);
}

std::size_t cycles_apart(const Seen& a, const Seen& b) {
  if (a.records.size() != b.records.size()) return a.records.size() + b.records.size();
  std::size_t apart = 0;
  for (std::size_t i = 0; i < a.records.size(); ++i) {
    apart += same(a.records[i], b.records[i]) ? 0 : 1;
  }
  return apart;
}

TEST(EffortNoiseOfATorqueCell, IsTheSameForTheSameSeedAndEndsNoRun) {
  const Cell cell = load_cell(in_tree("tests/plans/torque_gantry3/cell.yaml"));
  const Seen first = run_with(cell, gantry_cell(), 2.0, 1);
  EXPECT_EQ(cycles_apart(first, run_with(cell, gantry_cell(), 2.0, 1)), 0U);
  EXPECT_GT(cycles_apart(first, run_with(cell, gantry_cell(), 2.0, 2)), 0U);
  for (const double noise_permille : {0.0, 0.3, 1.0, 2.0, 3.0}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Seen run = run_with(cell, gantry_cell(), noise_permille, seed);
      EXPECT_EQ(run.result.ending.reason, executor::EndReason::kPlanDone)
          << noise_permille << ", " << seed << ": " << run.result.reason;
    }
  }
}

}  // namespace
}  // namespace tenon::tests
