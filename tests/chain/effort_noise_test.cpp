// What drives report of their efforts has noise: a run whose efforts tell the force is the same for
// the same seed, and done with it as with coarse drives that have none. Where a sensor tells the
// force nobody asks for efforts, and all that noise changes is how long frames are on the bus.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
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

/// To the bit, whenever it was.
bool same_but_time(const executor::CycleRecord& a, const executor::CycleRecord& b) {
  const auto bits = [](const auto& values) {
    std::vector<std::uint64_t> all;
    for (const double value : values) all.push_back(std::bit_cast<std::uint64_t>(value));
    return all;
  };
  return a.state == b.state && a.arm_state == b.arm_state && a.request == b.request &&
         a.end_reason == b.end_reason && a.motion_ns == b.motion_ns && a.move_ns == b.move_ns &&
         a.step == b.step && a.phase == b.phase && a.signature == b.signature &&
         a.wrench_fresh == b.wrench_fresh && a.joints_fresh == b.joints_fresh &&
         bits(a.position) == bits(b.position) &&
         bits(a.position_commanded) == bits(b.position_commanded) &&
         bits(a.wrench_raw) == bits(b.wrench_raw) && bits(a.wrench) == bits(b.wrench) &&
         bits(a.pose.position_m) == bits(b.pose.position_m) &&
         bits(a.pose.orientation_wxyz) == bits(b.pose.orientation_wxyz) &&
         bits(a.velocity) == bits(b.velocity);
}

bool same(const executor::CycleRecord& a, const executor::CycleRecord& b) {
  return a.time_ns == b.time_ns && same_but_time(a, b);
}

std::size_t cycles_apart(const Seen& a, const Seen& b,
                         bool (&equal)(const executor::CycleRecord&,
                                       const executor::CycleRecord&)) {
  if (a.records.size() != b.records.size()) return a.records.size() + b.records.size();
  std::size_t apart = 0;
  for (std::size_t i = 0; i < a.records.size(); ++i) {
    apart += equal(a.records[i], b.records[i]) ? 0 : 1;
  }
  return apart;
}

std::int64_t time_apart_ns(const Seen& a, const Seen& b) {
  std::int64_t apart_ns = 0;
  for (std::size_t i = 0; i < std::min(a.records.size(), b.records.size()); ++i) {
    apart_ns = std::max(apart_ns, std::abs(a.records[i].time_ns - b.records[i].time_ns));
  }
  return apart_ns;
}

TEST(EffortNoiseOfATorqueCell, IsTheSameForTheSameSeedAndEndsNoRun) {
  const Cell cell = load_cell(in_tree("tests/plans/torque_gantry3/cell.yaml"));
  const Seen first = run_with(cell, gantry_cell(), 2.0, 1);
  EXPECT_EQ(cycles_apart(first, run_with(cell, gantry_cell(), 2.0, 1), same), 0U);
  EXPECT_GT(cycles_apart(first, run_with(cell, gantry_cell(), 2.0, 2), same_but_time), 0U);
  // With three counts the tare reads 0.24 N and more where it takes 0.2, and says so.
  for (const double noise_permille : {0.0, 0.3, 1.0, 2.0, 2.4}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Seen run = run_with(cell, gantry_cell(), noise_permille, seed);
      EXPECT_EQ(run.result.ending.reason, executor::EndReason::kPlanDone)
          << noise_permille << ", " << seed << ": " << run.result.reason;
    }
  }
}

class EffortNoise : public ::testing::TestWithParam<const char*> {};

// Other bits of an effort, and of the checksum over it, call for other stuff bits: feedback is
// there some bits sooner or later, and a record tells when that was.
TEST_P(EffortNoise, ChangesNothingButWhenFramesArriveWhereASensorTellsTheForce) {
  const Cell cell = load_cell(in_tree(std::string("hw/cells/") + GetParam() + ".yaml"));
  ASSERT_FALSE(cell.joint_torque);
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Seen without = run_with(cell, cell, 0.0, seed);
    const Seen with = run_with(cell, cell, 2.0, seed);
    EXPECT_EQ(without.result.ending.reason, executor::EndReason::kPlanDone);
    EXPECT_EQ(cycles_apart(without, with, same_but_time), 0U) << seed;
    EXPECT_EQ(without.result.truth.error, with.result.truth.error) << seed;
    EXPECT_EQ(without.result.truth.contact_force_N_max, with.result.truth.contact_force_N_max);
    // Of eight bytes, one of each joint.
    constexpr std::int64_t kStuffBitsMost = (34 + 8 * 8 - 1) / 4;
    const auto joints = static_cast<std::int64_t>(cell.robot.joints.size());
    const std::int64_t apart_ns = time_apart_ns(without, with);
    EXPECT_LE(apart_ns * cell.robot.bitrate_bps, joints * kStuffBitsMost * 1'000'000'000) << seed;
    EXPECT_GT(apart_ns, 0) << "the noise has reached no frame";
  }
}

INSTANTIATE_TEST_SUITE_P(All, EffortNoise, ::testing::Values("gantry3", "csp6", "mit6"),
                         [](const auto& cell) { return std::string(cell.param); });

}  // namespace
}  // namespace tenon::tests
