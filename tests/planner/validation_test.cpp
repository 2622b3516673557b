// What validation runs besides its draws.

#include "planner/judge/validation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include "planner/belief/belief.h"
#include "planner/judge/refutation.h"
#include "planner/report/summary.h"
#include "tests/planner/room_plan.h"

namespace tenon::planner {
namespace {

PlanReport planned_by(std::size_t draws, const Task& task) {
  PlannerOptions options;
  options.draws = draws;
  return make_plan(task, task.starts.front(), WallRollout(room()), options, stopped_clock);
}

TEST(Validation, TheRimStandsWhereDrawingEndsAndCountsInNoStatistic) {
  Task task = room_task();
  const PlanReport report = planned_by(20, task);
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  const Validation& validation = report.validation;
  const Start& start = task.starts.front();
  const double sigmas = task.particle_sigmas + 1.0;
  // Four tips and four corners, each slippery and rough, on an arm at once and late.
  ASSERT_EQ(validation.rim.size(), 32U);
  for (const Draw& draw : validation.rim) {
    EXPECT_EQ(draw.sigmas_out, sigmas);
    const Vector3 off_m = draw.chain.start.pose.position_m - start.pose.position_m;
    EXPECT_NEAR(off_m.norm(), sigmas * start.sigma[0], 1e-12);
    EXPECT_TRUE(draw.at_goal);
  }
  EXPECT_EQ(validation.draws.size(), 20U);
  EXPECT_EQ(report.plan->draws, 20U);
  EXPECT_LE(validation.at_goal(), 20U);
  EXPECT_EQ(good_chains(validation.draws).size(), validation.at_goal());
}

TEST(Validation, AStartOnTheRimStaysWithinTheEnvelopesHoweverFewWereDrawn) {
  const Task task = room_task();
  const PlanReport report = planned_by(1, task);
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  const double reach_m = (task.particle_sigmas + 1.0) * task.starts.front().sigma[0];
  WallRollout rollout(room());
  for (const Vector3& way : {Vector3(1, 0, 0), Vector3(-1, 0, 0), Vector3(0, 1, 0),
                             Vector3(0, -1, 0), Vector3(0.6, 0.8, 0), Vector3(-0.8, 0.6, 0)}) {
    Particle particle;
    particle.pose = task.starts.front().pose;
    particle.pose.position_m += reach_m * way;
    const Chain chain = run_chain(rollout, *report.plan, particle, task.rollout_step_us);
    EXPECT_TRUE(chain.done) << chain.failure;
  }
}

TEST(Validation, CornersStandOnTheRimOfTheReachWithEveryExtremeOfPhysics) {
  Task task = room_task();
  task.oversize_m = 1e-3;
  const PlanReport report = planned_by(20, task);
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  const std::vector<Draw>& corners = report.validation.corners;
  // Four tips and four corners, at two frictions, two sizes and two latencies.
  ASSERT_EQ(corners.size(), 64U);
  EXPECT_EQ(arrived(corners), 64U);
  std::set<std::array<double, 3>> physics;
  for (const Draw& draw : corners) {
    EXPECT_EQ(draw.sigmas_out, task.particle_sigmas);
    const PhysicalParameters& one = draw.chain.start.physics;
    physics.insert({one.friction, one.oversize_m, one.latency_s});
  }
  std::set<std::array<double, 3>> expected;
  for (const double friction : {task.friction.low, task.friction.high}) {
    for (const double oversize_m : {0.0, 1e-3}) {
      for (const double latency_s : {0.0, report.plan->latency_max_s}) {
        expected.insert({friction, oversize_m, latency_s});
      }
    }
  }
  EXPECT_EQ(physics, expected);
}

TEST(Validation, APlanIsJudgedByDrawsThatItsOwnBytesChoose) {
  const Task task = room_task();
  const Plan plan = *planned_by(20, task).plan;
  Plan other = plan;
  other.cost += 1.0;
  other.bound = 1.0;
  other.draws = 7;
  other.draws_at_goal = 3;
  EXPECT_EQ(judging_seed(other), judging_seed(plan));
  other = plan;
  other.steps.front().displacement.x() += 1e-3;
  EXPECT_NE(judging_seed(other), judging_seed(plan));
}

TEST(Validation, WhatWouldStopADrawLeavesOutAllBehindItAtAnyNumberOfThreads) {
  const Task task = room_task();
  const Plan plan = *planned_by(20, task).plan;
  for (const std::size_t threads : {1U, 4U}) {
    RolloutPool pool(WallRollout(room()), threads);
    const auto starts =
        drawn_starts(5, 100, DrawnPhysics::kEven, plan, task, task.starts.front(), pool.front());
    const auto far = [&](const Draw& draw) { return draw.sigmas_out > 1.9; };
    const auto all = run_starts(plan, task, starts, pool);
    const auto until = run_starts(plan, task, starts, pool, far);
    ASSERT_EQ(all.size(), 100U);
    ASSERT_LT(until.size(), 100U);
    EXPECT_TRUE(far(until.back()));
    EXPECT_EQ(std::find_if(all.begin(), all.end(), far) - all.begin() + 1,
              static_cast<std::ptrdiff_t>(until.size()));
  }
}

TEST(Validation, OtherRulesDecideOnTheSameMovesWithoutSimulatingThem) {
  const Task task = room_task();
  const PlanReport report = planned_by(20, task);
  Plan strict = *report.plan;
  for (OutcomeRule& rule : strict.steps.front().outcomes) rule.successor = kSuccessorFail;
  for (const Draw& draw : decided_by(strict, task, report.validation.corners)) {
    EXPECT_FALSE(draw.at_goal);
    EXPECT_EQ(draw.chain.moves.size(), 1U);
    EXPECT_FALSE(draw.chain.failure.empty());
  }
  EXPECT_EQ(arrived(decided_by(*report.plan, task, report.validation.corners)), 32U);
}

TEST(Validation, TheFirstDrawWithinReachThatMissedSpeaksWithThePhysicsThatItHad) {
  Task task = room_task();
  task.oversize_m = 1e-3;
  std::vector<Draw> draws(4);
  const Start& start = task.starts.front();
  draws[0].sigmas_out = 1.0;
  draws[0].at_goal = true;
  EXPECT_EQ(missed_draw({&draws[0], 1}, 2.0), nullptr);
  draws[1].sigmas_out = 2.5;
  EXPECT_EQ(missed_draw({draws.data(), 2}, 2.0), nullptr) << "beyond the promise";
  draws[2].sigmas_out = 1.5;
  draws[2].chain.start.physics = {0.6, 5e4, 1e-3, 0.007};
  draws[2].chain.steps = {0, 1};
  draws[2].chain.failure = "outcome contact has no successor";
  const std::string stopped = ": step 1: outcome contact has no successor";
  EXPECT_EQ(missed_draw(draws, 2.0), &draws[2]);
  EXPECT_EQ(refutation_of(draws[2], task, start).why,
            "a start 1.50 sigma out missed the goal at friction 0.6, latency 7.0 ms, the part 1 mm "
            "larger than drawn" +
                stopped);

  task.tilt_rad = 3e-3;
  Pose& environment = draws[2].chain.start.environment;
  const auto ends_in = [&](const std::string& end) {
    return refutation_of(draws[2], task, start).why.ends_with(end + stopped);
  };
  EXPECT_TRUE(ends_in("larger than drawn"));
  environment.orientation = rotation_of({0.0, 0.0, -3e-3});
  EXPECT_TRUE(ends_in("larger than drawn, tilted by -0.17 degrees about z"));
  environment.orientation = rotation_of({1e-3, 2e-3, 0.0});
  EXPECT_TRUE(ends_in("larger than drawn, tilted by 0.13 degrees"));
  draws[2].chain.start.pose.orientation = rotation_of({0.0, 2e-3, 0.0}) * start.pose.orientation;
  EXPECT_TRUE(ends_in(
      "larger than drawn, tilted by 0.13 degrees, the part tilted in the hand by 0.11 degrees "
      "about y"));
  environment.orientation.setIdentity();
  EXPECT_TRUE(ends_in("larger than drawn, the part tilted in the hand by 0.11 degrees about y"));
}

TEST(Validation, AStartOnTheRimThatCollidesIsLeftOut) {
  Task task = room_task();
  // Three standard deviations end 2 mm before the wall at x = -0.5, four beyond it.
  task.particle_sigmas = 3.0;
  task.starts.front().sigma[0] = (0.5 - 0.23 - 2e-3) / 3.0;
  const PlanReport report = planned_by(20, task);
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  EXPECT_EQ(report.validation.rim.size(), 28U);
}

TEST(Validation, DrawsThatWereStoppedInOneStepAreOneLine) {
  const Task task = room_task();
  PlanReport report = planned_by(20, task);
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  EXPECT_EQ(summary(report, task, "plan.tnp").find("missed:"), std::string::npos);
  for (const std::size_t i : {1U, 4U, 5U, 9U}) {
    Draw& draw = report.validation.draws[i];
    draw.at_goal = false;
    draw.sigmas_out = 0.1 * static_cast<double>(i);
    // The last two went on to an end beside the goal.
    if (i >= 5U) draw.chain.moves.back().pose.position_m.x() += 0.01;
    if (i >= 5U) continue;
    draw.chain.done = false;
    draw.chain.failure = "outcome contact has no successor";
  }
  const std::string text = summary(report, task, "plan.tnp");
  EXPECT_NE(text.find("missed: 0.10 sigma out, step "), std::string::npos) << text;
  EXPECT_NE(text.find(": outcome contact has no successor; 1 more there\n"), std::string::npos);
  EXPECT_NE(text.find("missed: 0.50 sigma out, ended "), std::string::npos) << text;
  EXPECT_NE(text.find(" degrees from the goal; 1 more beside it\n"), std::string::npos) << text;
  // The statistics have each.
  EXPECT_EQ(missed(report, task).size(), 4U);
}

/// Runs starts whose friction says which they are; those of `misses` miss.
std::vector<double> ran_past(const std::vector<double>& misses, std::size_t count) {
  std::vector<JudgedStart> starts(count);
  for (std::size_t i = 0; i < count; ++i) {
    starts[i].particle.physics.friction = static_cast<double>(i);
  }
  const auto run = [&](std::span<const JudgedStart> some) {
    std::vector<Draw> draws;
    for (const JudgedStart& start : some) {
      Draw& draw = draws.emplace_back();
      draw.chain.start = start.particle;
      draw.at_goal = std::ranges::find(misses, start.particle.physics.friction) == misses.end();
    }
    return draws;
  };
  std::vector<double> ran;
  for (const Draw& draw : run_past_miss(starts, 2.0, 10, run)) {
    ran.push_back(draw.chain.start.physics.friction);
  }
  EXPECT_TRUE(std::ranges::is_sorted(ran));
  EXPECT_EQ(std::ranges::adjacent_find(ran), ran.end());
  return ran;
}

TEST(Validation, OfManyStartsAsManyMoreAreRunAsItTakesToFindOneThatMisses) {
  for (const std::size_t count : {1U, 2U, 7U, 64U, 1000U}) {
    EXPECT_EQ(ran_past({}, count).size(), count);
  }
  EXPECT_EQ(ran_past({0.0}, 1000).size(), 20U) << "the first batch and another";
  EXPECT_EQ(ran_past({}, 0).size(), 0U);
  // Ten neighbours of a thousand are met early, wherever they are.
  for (double first = 0.0; first < 990.0; first += 30.0) {
    std::vector<double> misses;
    for (int i = 0; i < 10; ++i) misses.push_back(first + i);
    EXPECT_LE(ran_past(misses, 1000).size(), 400U) << first;
  }
}

}  // namespace
}  // namespace tenon::planner
