// Tasks as newcomers write them from the README: no key in them was chosen so that they plan.

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "planner/planner.h"
#include "shared/config/load.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "tests/support/scratch_folder.h"

namespace tenon {
namespace {

using planner::PlanReport;
using planner::PlanStatus;

// A square peg of 40 mm, a pocket of 42 mm in a plate, its place and height known to 8 mm.
constexpr const char* kPocket = R"(name: pocket
coordinates: [x, y, z]
held:
  - {name: peg, box_m: [0.040, 0.040, 0.100], pose: {position_m: [0, 0, 0.050]}}
environment:
  - {name: left, box_m: [0.079, 0.200, 0.040], pose: {position_m: [-0.0605, 0, 0.020]}}
  - {name: right, box_m: [0.079, 0.200, 0.040], pose: {position_m: [0.0605, 0, 0.020]}}
  - {name: front, box_m: [0.042, 0.079, 0.040], pose: {position_m: [0, -0.0605, 0.020]}}
  - {name: back, box_m: [0.042, 0.079, 0.040], pose: {position_m: [0, 0.0605, 0.020]}}
  - {name: bottom, box_m: [0.200, 0.200, 0.010], pose: {position_m: [0, 0, -0.005]}}
starts:
  - {name: above, pose: {position_m: [0.01, -0.02, 0.10]}, sigma_m: [0.008, 0.008, 0.008]}
goal: {pose: {position_m: [0, 0, 0.005]}, tolerance_m: 2e-3}
speeds: {approach_mps: 0.10, contact_mps: 0.05}
contact: {force_on_N: 9, force_keep_N: 3, force_off_N: 1.5, debounce_s: 0.006, force_limit_N: 20}
compliance: {axes: [x, y, z], mass_kg: 2.0, damping_Nspm: 1500, stiffness_Npm: 1000}
physics: {friction: {low: 0.1, nominal: 0.3, high: 0.6}, contact_stiffness_Npm: 5e4}
)";

PlanReport planned(const std::string& text) {
  const tests::ScratchFolder folder;
  const Task task = load_task(folder.put("task.yaml", text));
  planner::PlannerOptions options;
  options.draws = 50;
  options.threads = 2;
  options.expansions_max = 100;
  return planner::make_plan(task, task.starts.front(), sim::OdeRollout(task), options);
}

TEST(NewcomersTask, WhatItLeavesOutFollowsFromItsSizes) {
  const tests::ScratchFolder folder;
  const Task task = load_task(folder.put("task.yaml", kPocket));
  EXPECT_TRUE(task.guide_moves);
  EXPECT_DOUBLE_EQ(task.step_m, 1.2 * task.particle_sigmas * 0.008);
  EXPECT_GE(task.long_step_m, 0.2);
  EXPECT_GT(task.attractor_samples, 0U);
  EXPECT_EQ(task.goal_uncertainty_m2, 0.0);  // for the planner to say
  EXPECT_EQ(task.w1, 3.0);
  const std::string moves = "primitives: {step_m: 0.1, long_step_m: 1.0, direct_reach_m: 0.3}\n";
  EXPECT_FALSE(load_task(folder.put("said.yaml", kPocket + moves)).guide_moves);
}

TEST(NewcomersTask, ASquarePocketInSpaceIsPlannedWithDefaultKeys) {
  const PlanReport report = planned(kPocket);
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  EXPECT_GT(report.guides, 0U);
  EXPECT_TRUE(report.certification.holds());
  EXPECT_EQ(planner::arrived(report.validation.corners), report.validation.corners.size());
  std::printf("%zu expansions, %zu refuted paths, %zu steps, %zu of %zu draws\n", report.expansions,
              report.refusals.size(), report.plan->steps.size(), report.validation.at_goal(),
              report.validation.draws.size());
}

TEST(NewcomersTask, WithoutAFaceAcrossYItIsSaidThatNothingSettlesIt) {
  // A table and nothing else.
  std::string text = kPocket;
  const std::size_t from = text.find("  - {name: left");
  text.erase(from, text.find("  - {name: bottom") - from);
  const std::string table = "box_m: [0.200, 0.200, 0.010]";
  text.replace(text.find(table), table.size(), "box_m: [3.0, 3.0, 0.010]");
  const PlanReport report = planned(text);
  ASSERT_NE(report.status, PlanStatus::kPlanned);
  EXPECT_NE(report.reason.find("nothing that was pushed against settles x, y: it takes a face"),
            std::string::npos)
      << report.reason;
  EXPECT_NE(report.reason.find("or a smaller sigma there"), std::string::npos) << report.reason;
  text.replace(text.find("sigma_m"), 7, "uniform_m");
  const PlanReport bounded = planned(text);
  EXPECT_NE(bounded.reason.find("or a smaller uniform bound there"), std::string::npos)
      << bounded.reason;
}

}  // namespace
}  // namespace tenon
