// What validation runs besides its draws.

#include "planner/judge/validation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
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

TEST(Validation, ALookAtTheCornersHasEachOfThemOnceAndEveryPhysicsOnEverySide) {
  Task task = room_task();
  task.coordinates = 0b111111;
  task.starts.front().sigma << 0.03, 0.03, 0.03, 0.02, 0.02, 0.02;
  Plan plan;
  plan.latency_max_s = 0.008;
  WallRollout rollout(room());
  const Start& start = task.starts.front();
  const auto all = corner_starts(plan, task, start, rollout);
  const auto looked = screening_starts(plan, task, start, rollout);
  ASSERT_EQ(looked.size(), 76U);
  ASSERT_EQ(all.size(), 4 * looked.size());
  const auto physics_of = [](const JudgedStart& one) {
    return std::array{one.particle.physics.friction, one.particle.physics.latency_s};
  };
  for (std::size_t i = 0; i < looked.size(); ++i) {
    EXPECT_EQ(looked[i].particle.pose, all[4 * i].particle.pose);
    EXPECT_EQ(looked[i].particle.environment, all[4 * i].particle.environment);
  }
  for (int axis = 0; axis < 6; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      std::set<std::array<double, 2>> physics;
      for (const JudgedStart& one : looked) {
        const Vector6 off = displacement_between(start.pose, one.particle.tool());
        if (side * off[axis] > 1e-6) physics.insert(physics_of(one));
      }
      EXPECT_EQ(physics.size(), 4U) << axis << " " << side;
    }
  }
}

/// Of the environment and of the part in the hand, in microradians.
using Urad = std::array<double, 6>;

Urad urad_of(const Tilt& tilt) {
  const Vector3 a = 1e6 * tilt.environment_rad;
  const Vector3 b = 1e6 * tilt.held_rad;
  Urad urad{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()};
  for (double& one : urad) one = std::round(one) + 0.0;  // no -0
  return urad;
}

TEST(Validation, StartsOfAPassageHaveEveryTiltWithEverySizeFromAllOverTheRim) {
  Task task = room_task();
  task.tilt_rad = 3e-3;
  task.oversize_m = 1e-3;
  Plan plan;
  plan.latency_max_s = 0.008;
  WallRollout rollout(room());
  std::map<double, int> from_x;
  std::map<Urad, std::set<double>> sizes;
  for (const JudgedStart& one : passage_starts(plan, task, task.starts.front(), rollout)) {
    const Particle level = without_tilt(one.particle, task, task.starts.front());
    ++from_x[std::round(1e6 * level.tool().position_m.x())];
    const Tilt tilt = tilt_of(one.particle, task, task.starts.front());
    sizes[urad_of(tilt)].insert(one.particle.physics.oversize_m);
  }
  // Two tips along x, those along y between them, and the corners to either side.
  EXPECT_EQ(from_x.size(), 5U);
  for (const auto& [x_um, count] : from_x) EXPECT_GE(count, 2) << x_um;
  EXPECT_EQ(sizes.size(), 25U);
  for (const auto& [tilt, both] : sizes) EXPECT_EQ(both.size(), 2U) << tilt[0] << " " << tilt[1];
}

TEST(Validation, CornersAreTiltedInTurnAboutEveryAxisThatIsNoCoordinate) {
  Task task = room_task();
  task.coordinates = 0b010011;  // x, y and ry
  task.tilt_rad = 2e-3;
  task.starts.front().sigma[4] = 0.1;
  const Particle turned =
      particle_off(0.1 * Vector6::Unit(4), task, task.starts.front(), PhysicalParameters{});
  EXPECT_EQ(tilt_of(turned, task, task.starts.front()).norm_rad(), 0.0) << "a coordinate";
  task.starts.front().sigma[4] = 0.0;
  Plan plan;
  plan.latency_max_s = 0.008;
  WallRollout rollout(room());
  std::map<double, std::set<Urad>> tilts;  // by friction
  for (const JudgedStart& start : corner_starts(plan, task, task.starts.front(), rollout)) {
    const Start& nominal = task.starts.front();
    tilts[start.particle.physics.friction].insert(urad_of(tilt_of(start.particle, task, nominal)));
    const Particle level = without_tilt(start.particle, task, nominal);
    EXPECT_EQ(tilt_of(level, task, nominal).norm_rad(), 0.0);
    // The part is turned about the tool.
    EXPECT_EQ(level.pose.position_m, start.particle.pose.position_m);
    // About the goal, which stays where it is.
    EXPECT_LT(
        (compose(start.particle.environment, task.goal).position_m - task.goal.position_m).norm(),
        1e-12);
  }
  // Of the environment, of the part, of both, and of one against the other.
  constexpr std::array<std::array<double, 2>, 4> kKinds = {
      {{2000.0, 0.0}, {0.0, 2000.0}, {1414.0, 1414.0}, {1414.0, -1414.0}}};
  std::set<Urad> each = {Urad{}};
  for (const std::size_t axis : {0U, 2U}) {  // rx and rz
    for (const auto& [environment_urad, held_urad] : kKinds) {
      for (const double way : {1.0, -1.0}) {
        Urad one{};
        one[axis] = way * environment_urad;
        one[axis + 3] = way * held_urad + 0.0;
        each.insert(one);
      }
    }
  }
  ASSERT_EQ(tilts.size(), 2U);
  std::set<Urad> all;
  for (const auto& [friction, some] : tilts) {
    EXPECT_GT(some.size(), each.size() / 2) << "of friction " << friction;
    all.insert(some.begin(), some.end());
  }
  EXPECT_EQ(all, each);

  // What moves that turn with the tool go by has no turn that the arm does not know of.
  task.motion.carried_axes = true;
  const std::vector<JudgedStart> starts = corner_starts(plan, task, task.starts.front(), rollout);
  EXPECT_TRUE(std::all_of(starts.begin(), starts.end(), [&](const JudgedStart& start) {
    return tilt_of(start.particle, task, task.starts.front()).held_rad.isZero();
  }));
}

TEST(Validation, DrawsAreTiltedByAnythingUpToTheTasksTilt) {
  Task task = room_task();
  task.tilt_rad = 2e-3;
  WallRollout rollout(room());
  const auto drawn = [&] {
    return drawn_starts(5, 300, DrawnPhysics::kEven, Plan{}, task, task.starts.front(), rollout);
  };
  const std::vector<JudgedStart> tilted = drawn();
  Vector6 low = Vector6::Zero();
  Vector6 high = Vector6::Zero();
  for (const JudgedStart& start : tilted) {
    const Tilt tilt = tilt_of(start.particle, task, task.starts.front());
    EXPECT_LE(tilt.norm_rad(), 2e-3 + 1e-12);
    Vector6 both;
    both << tilt.environment_rad, tilt.held_rad;
    low = low.cwiseMin(both);
    high = high.cwiseMax(both);
  }
  EXPECT_LT(low.maxCoeff(), -1.3e-3);
  EXPECT_GT(high.minCoeff(), 1.3e-3);
  // Nothing else of them changes.
  task.tilt_rad = 0.0;
  const std::vector<JudgedStart> level = drawn();
  for (std::size_t i = 0; i < level.size(); ++i) {
    EXPECT_EQ(level[i].particle.pose.position_m, tilted[i].particle.pose.position_m);
    EXPECT_EQ(level[i].particle.physics, tilted[i].particle.physics);
    EXPECT_EQ(level[i].particle.pose.orientation.coeffs(),
              task.starts.front().pose.orientation.coeffs());
    EXPECT_EQ(level[i].particle.environment, Pose{});
  }
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
