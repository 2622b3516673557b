// What is drawn for a run, and how runs are handed out.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>

#include "shared/base/error.h"
#include "sim/cell/virtual_arm/environment_offset.h"
#include "sim/evaluation/quantity.h"
#include "sim/evaluation/run_all.h"
#include "sim/evaluation/trial.h"
#include "tests/sim/literal_cell.h"

namespace tenon::sim {
namespace {

Start start_with(double sigma_x_m, double sigma_y_m) {
  Start start;
  start.sigma.head<2>() << sigma_x_m, sigma_y_m;
  return start;
}

TEST(EvaluationTrial, ARunsDrawIsThatOfTenonSimWithItsSeed) {
  const Task task = wall_task();
  const Start start = start_with(0.03, 0.02);
  WorldRanges ranges;
  ranges.clearance_m.sigma = 1e-4;
  std::set<std::uint64_t> seeds;
  for (std::size_t number = 0; number < 1000; ++number) {
    const Trial trial = draw_trial(task, Cell{}, start, &ranges, 7, number);
    EXPECT_LT(trial.seed, std::uint64_t{1} << 53);
    EXPECT_EQ(trial.offset, draw_offset(task, start, trial.seed));
    EXPECT_EQ(trial.world.clearance_m, draw_world(ranges, task, trial.seed).clearance_m);
    seeds.insert(trial.seed);
  }
  EXPECT_EQ(seeds.size(), 1000U);
  EXPECT_NE(draw_trial(task, Cell{}, start, nullptr, 8, 0).seed,
            draw_trial(task, Cell{}, start, nullptr, 7, 0).seed);
}

TEST(EvaluationTrial, EveryPlanMeetsTheSameNormalDraws) {
  const Task task = wall_task();
  const Trial narrow = draw_trial(task, Cell{}, start_with(0.01, 0.02), nullptr, 7, 5);
  const Trial wide = draw_trial(task, Cell{}, start_with(0.03, 0.04), nullptr, 7, 5);
  EXPECT_DOUBLE_EQ(wide.offset.x(), 3.0 * narrow.offset.x());
  EXPECT_DOUBLE_EQ(wide.offset.y(), 2.0 * narrow.offset.y());
  EXPECT_DOUBLE_EQ(wide.distance, narrow.distance);
}

TEST(EvaluationTrial, DistancesAreDistributedAsThoseOfAPlaneNormal) {
  const Task task = wall_task();
  const Start start = start_with(0.03, 0.001);
  int within_two = 0;
  constexpr int kDraws = 20'000;
  for (std::size_t number = 0; number < kDraws; ++number) {
    within_two += draw_trial(task, Cell{}, start, nullptr, 3, number).distance <= 2.0;
  }
  // 1 - exp(-2), four standard deviations of the count
  EXPECT_NEAR(within_two / static_cast<double>(kDraws), 0.8646647, 4.0 * 0.00242);
}

TEST(EvaluationTrial, ATiltIsOfAxesThatAreNoCoordinatesOfTheTask) {
  Task task = wall_task();
  task.coordinates = 0b001011;  // x, y, rx
  Cell cell;
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3::UnitZ()));
  cell.X_BT.orientation = quarter;  // base y is task x, base x is task -y
  WorldDraw world;
  world.task_in_base_error << 0.1, 0.1, 0.1, 3e-3, 5e-3, 0.0;
  EXPECT_NEAR(tilt_of(world, task, cell), 3e-3, 1e-12);
  world.tool_in_flange_error << 0.1, 0.1, 0.1, 9e-3, 0.0, 4e-3;  // flange x is task x
  EXPECT_NEAR(tilt_of(world, task, cell), 5e-3, 1e-12);
  cell.X_FP.orientation = quarter;  // flange x is tool -y
  EXPECT_NEAR(tilt_of(world, task, cell), std::sqrt(9e-6 + 81e-6 + 16e-6), 1e-12);
  task.goal.orientation = quarter;  // and that is task x
  EXPECT_NEAR(tilt_of(world, task, cell), 5e-3, 1e-12);
}

TEST(EvaluationTrial, APlanPromisesNothingBeyondItsTasksReachOrTilt) {
  Task task = wall_task();
  task.particle_sigmas = 3.0;
  task.tilt_rad = 3e-3;
  Trial trial;
  trial.distance = 2.9;
  trial.tilt_rad = 2.9e-3;
  EXPECT_TRUE(within_promise(trial, task));
  EXPECT_EQ(tilt_text(trial), ", tilted by 0.17 degrees");
  trial.tilt_rad = 3.1e-3;
  EXPECT_FALSE(within_promise(trial, task));
  trial.tilt_rad = 0.0;
  EXPECT_EQ(tilt_text(trial), "");
  trial.distance = 3.1;
  EXPECT_FALSE(within_promise(trial, task));
}

TEST(EvaluationTrial, ShardsShareTheRunsOut) {
  std::set<std::pair<std::size_t, std::size_t>> seen;
  std::size_t jobs = 0;
  for (std::size_t shard = 0; shard < 3; ++shard) {
    for (const Job& job : jobs_of(2, 10, shard, 3)) {
      EXPECT_EQ(job.number % 3, shard);
      seen.insert({job.plan, job.number});
      ++jobs;
    }
  }
  EXPECT_EQ(jobs, 20U);
  EXPECT_EQ(seen.size(), 20U);
}

TEST(EvaluationTrial, EveryJobRunsOnceOnAnyNumberOfThreads) {
  const std::vector<Job> jobs = jobs_of(2, 50, 0, 1);
  for (const std::size_t threads : {1U, 2U, 7U}) {
    std::vector<std::size_t> ended(100);
    run_all(
        jobs, threads,
        [](const Job& job) {
          sim::Run run;
          run.trial.number = 2 * job.number + job.plan;
          return run;
        },
        [&](const Job&, const sim::Run& run) { ++ended[run.trial.number]; });
    EXPECT_EQ(std::count(ended.begin(), ended.end(), 1U), 100) << threads;
  }
}

TEST(EvaluationTrial, WhatARunThrowsEndsTheOthersAndComesBack) {
  std::atomic<int> runs = 0;
  const auto run = [&](const Job& /*job*/) -> sim::Run {
    if (++runs >= 3) throw std::runtime_error("third");
    return {};
  };
  EXPECT_THROW(run_all(jobs_of(1, 1000, 0, 1), 2, run, [](const Job&, const sim::Run&) {}),
               std::runtime_error);
  // Each of the two threads was in one run at most when the first threw.
  EXPECT_LE(runs, 4);
}

TEST(EvaluationQuantity, BinsAreHalfOpenButForTheLast) {
  const Bins bins = parse_bins("friction=0.1:0.7:3");
  EXPECT_EQ(bins.count, 3U);
  EXPECT_NEAR(bins.edges(1).low, 0.3, 1e-12);
  EXPECT_NEAR(bins.edges(1).high, 0.5, 1e-12);
  const auto bin = [&](double friction) {
    Trial trial;
    trial.world.friction = friction;
    return bins.bin_of(trial);
  };
  EXPECT_EQ(bin(0.1), 0U);
  EXPECT_EQ(bin(0.31), 1U);
  EXPECT_EQ(bin(0.7), 2U);
  EXPECT_FALSE(bin(0.05));
  EXPECT_FALSE(bin(0.71));
  EXPECT_FALSE(bins.bin_of(Trial{}));  // not drawn
}

TEST(EvaluationQuantity, OfSeveralAxesItIsTheNorm) {
  Trial trial;
  trial.world.task_in_base_error << 0.0, 0.0, 0.0, 0.03, 0.04, 0.0;
  EXPECT_EQ(parse_bins("task_in_base_error_rad=0:0.1:10").bin_of(trial), 5U);
  EXPECT_EQ(parse_bins("task_in_base_error_m=0:0.1:10").bin_of(trial), 0U);
}

TEST(EvaluationQuantity, WhatIsNoRangeIsRefused) {
  for (const char* text :
       {"", "friction", "friction=", "friction=0.1", "friction=0.1:0.7", "friction=0.7:0.1:3",
        "friction=0.1:0.1:3", "friction=0.1:0.7:0", "friction=0.1:0.7:101", "friction=0.1:0.7:3x",
        "friction=a:0.7:3", "friction=0.1:nan:3", "colour=0:1:2"}) {
    EXPECT_THROW(static_cast<void>(parse_bins(text)), InputError) << text;
  }
}

}  // namespace
}  // namespace tenon::sim
