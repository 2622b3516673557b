// The whole chain in worlds that are not the planner's.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "shared/config/load.h"
#include "shared/system/fan_out.h"
#include "sim/cell/virtual_arm/world_draw.h"
#include "tests/support/places.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

constexpr std::uint64_t kSeeds = 6;

std::string truth_of(std::uint64_t seed) {
  static const WorldRanges ranges = load_experiment(in_tree("sim/experiments/box_on_table.yaml"));
  WholeRun::Options options;
  options.start = "1";
  options.seed = seed;
  options.world = sim::draw_world(ranges, box_task(), seed);
  double distance = 0.0;
  options.offset = draw_offset(box_task(), box_start("1"), seed, distance);
  const auto result = WholeRun(gantry_cell(), box_task(), box_plan("1"), options).run();
  EXPECT_EQ(result.truth.solver_messages, 0U) << seed;
  return result.reason + "\n" + sim::truth_json(result.truth);
}

std::vector<std::string> truths_on(std::size_t thread_count) {
  std::vector<std::string> truths(kSeeds);
  fan_out(kSeeds, thread_count,
          [&](std::size_t i, std::size_t /*worker*/) { truths[i] = truth_of(i + 1); });
  return truths;
}

TEST(World, RunsInDrawnWorldsAreTheSameOnOneThreadAndOnTwo) {
  const std::vector<std::string> one = truths_on(1);
  EXPECT_EQ(one, truths_on(2));
  EXPECT_NE(one[0], one[1]);
}

WholeRun::Result run_in(const sim::WorldDraw& world) {
  WholeRun::Options options;
  options.start = "1";
  options.world = world;
  return WholeRun(gantry_cell(), box_task(), box_plan("1"), options).run();
}

TEST(World, ATableThatCalibrationMisplacedIsFoundByTouch) {
  sim::WorldDraw world;
  world.task_in_base_error.head<2>() << 0.004, -0.003;
  const auto found = run_in(world);
  EXPECT_EQ(found.ending.reason, executor::EndReason::kPlanDone) << found.reason;
  EXPECT_TRUE(found.truth.within_tolerance) << found.truth.error_norm_m;
}

TEST(World, AStifferContactIsPressedHarder) {
  sim::WorldDraw soft;
  soft.contact_stiffness_Npm = 1e4;
  sim::WorldDraw hard;
  hard.contact_stiffness_Npm = 4e5;
  const double soft_N = run_in(soft).truth.contact_force_N_max;
  const double hard_N = run_in(hard).truth.contact_force_N_max;
  EXPECT_GT(hard_N, 1.2 * soft_N);
}

TEST(World, ACalibrationErrorBeyondThePlansEnvelopesChangesTheOutcome) {
  sim::WorldDraw world;
  world.task_in_base_error[0] = -0.18;
  const auto result = run_in(world);
  EXPECT_EQ(result.ending.reason, executor::EndReason::kPlanFailed) << result.reason;
  EXPECT_FALSE(result.truth.within_tolerance);
}

}  // namespace
}  // namespace tenon::tests
