// The whole planner on the exact double, and its parts that judge a plan.

#include "planner/planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "planner/collision.h"
#include "planner/judge/plan_draft.h"
#include "shared/base/error.h"
#include "shared/plan/codec.h"
#include "tests/planner/room_plan.h"

namespace tenon::planner {
namespace {

TEST(Planner, FindsAPlanThatBringsEveryDrawToTheGoal) {
  const Task task = room_task();
  const PlanReport report = planned(task);
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  EXPECT_EQ(report.plan->draws, 200U);
  EXPECT_EQ(report.validation.at_goal_within(2.0), report.validation.within(2.0));
  EXPECT_TRUE(report.plan->check_envelopes);
  EXPECT_GE(report.plan->bound, 1.0);
  EXPECT_LE(report.plan->bound, task.w1 * task.w2 + 1e-9);
  EXPECT_LE(report.bytes.size(), 2048U);
}

TEST(Planner, TheBytesAreThePlanAndCertifyAgain) {
  const Task task = room_task();
  const PlanReport report = planned(task);
  ASSERT_EQ(report.status, PlanStatus::kPlanned);
  EXPECT_EQ(encode_plan(*report.plan), report.bytes);
  RolloutPool pool(WallRollout(room()), 1);
  const Certification again = certify(report.bytes, task, pool);
  EXPECT_TRUE(again.holds());
  EXPECT_EQ(again.cost, report.plan->cost);
}

TEST(Planner, ThreadsDoNotChangeAByte) {
  const Task task = room_task();
  PlannerOptions two;
  two.threads = 2;
  PlannerOptions five;
  five.threads = 5;
  const auto one = planned(task).bytes;
  ASSERT_FALSE(one.empty());
  EXPECT_EQ(one, planned(task, room(), two).bytes);
  EXPECT_EQ(one, planned(task, room(), five).bytes);
}

TEST(Planner, AStartThatRefutesAPathBecomesAParticle) {
  // No particle pushes against the ledge; one draw in five does, and would end 50 mm beside the
  // goal.
  WallRollout::World world = room();
  world.ledge_m = 0.05;
  world.ledge_from_y_m = -0.095;
  world.ledge_to_y_m = -0.065;
  const Task task = room_task();
  std::string said;
  PlannerOptions options;
  options.progress = [&](const std::string& line) { said += line + "\n"; };
  const PlanReport report = planned(task, world, options);
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  EXPECT_EQ(report.validation.at_goal_within(2.0), report.validation.within(2.0));
  ASSERT_FALSE(report.refusals.empty());
  for (const std::string& refusal : report.refusals) {
    EXPECT_NE(said.find("0.0 s: refuted: " + refusal + "\n"), std::string::npos) << said;
  }
  for (const std::string& refusal : report.refusals) {
    EXPECT_NE(refusal.find("missed the goal"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("; it becomes a particle"), std::string::npos) << refusal;
  }
  EXPECT_LE(report.refusals.size(), 2U);
  EXPECT_LE(report.plan->bound, task.w1 * task.w2);
}

TEST(Planner, ADrawThatOnlyTheEnvelopesWouldHaveSeenRefutesThePathToo) {
  const Task task = room_task();
  const Start& start = task.starts.front();
  Plan free = *planned(task).plan;
  free.check_envelopes = false;
  // The ledge is so narrow that none of the first draws meets it.
  WallRollout::World world = room();
  world.ledge_m = 0.05;
  world.ledge_from_y_m = -0.1130;
  world.ledge_to_y_m = -0.1125;
  RolloutPool pool(WallRollout(world), 1);
  const auto missed = [&](std::uint64_t seed) {
    Validation validation;
    validation.draws = run_starts(
        free, task,
        drawn_starts(seed, 200, DrawnPhysics::kCorners, free, task, start, pool.front()), pool);
    return validation.within(2.0) - validation.at_goal_within(2.0);
  };
  ASSERT_EQ(missed(kSearchSeed), 0U);
  ASSERT_GT(missed(kEnvelopeSeed), 0U);
  const PlanReport report = planned(task, world);
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  ASSERT_EQ(report.refusals.size(), 1U);
  EXPECT_NE(report.refusals[0].find("missed the goal at"), std::string::npos);
  EXPECT_NE(report.refusals[0].find("; it becomes a particle"), std::string::npos);
}

TEST(Planner, AnOutcomeThatNoDrawHadLeadsToFail) {
  const PlanReport report = planned(room_task());
  ASSERT_EQ(report.status, PlanStatus::kPlanned);
  for (std::size_t i = 0; i < report.plan->steps.size(); ++i) {
    const Step& step = report.plan->steps[i];
    EXPECT_EQ(step.rule(Outcome::kTimeout).successor, kSuccessorFail);
    EXPECT_EQ(step.rule(Outcome::kBlocked).successor, kSuccessorFail);
    const Successor next =
        i + 1 == report.plan->steps.size() ? kSuccessorDone : static_cast<Successor>(i + 1);
    for (const OutcomeRule& rule : step.outcomes) {
      if (rule.successor != kSuccessorFail) {
        EXPECT_EQ(rule.successor, next);
      }
    }
  }
}

TEST(Planner, CertificationRejectsAPlanWithAChangedDisplacement) {
  const Task task = room_task();
  const PlanReport report = planned(task);
  ASSERT_EQ(report.status, PlanStatus::kPlanned);
  RolloutPool pool(WallRollout(room()), 1);
  Plan changed = *report.plan;
  Step& last = changed.steps.back();
  last.displacement *= 0.9;
  const Certification refused = certify(encode_plan(changed), task, pool);
  ASSERT_FALSE(refused.holds());
  EXPECT_EQ(refused.refuting()->disagreement.step, changed.steps.size() - 1);
  EXPECT_NE(refused.refuting()->disagreement.why.find("its envelope is"), std::string::npos);
  // Without envelopes the chain simply ends beside the goal.
  changed.check_envelopes = false;
  const Certification beside = certify(encode_plan(changed), task, pool);
  ASSERT_FALSE(beside.holds());
  EXPECT_NE(beside.refuting()->disagreement.why.find("beside the goal"), std::string::npos);
}

TEST(Planner, CertificationRefutesAPlanThatOneParticleAloneLeaves) {
  Task task = room_task();
  Start& start = task.starts.front();
  start.sigma[1] = 0.0;
  task.goal.position_m = {0.5, start.pose.position_m.y(), 0.0};
  Plan plan = draft_plan(task, start, {}, std::vector<Vector6>{Vector6::Unit(0)});
  plan.check_envelopes = true;
  RolloutPool pool(WallRollout(room()), 1);
  const auto certified = [&](double travelled_min_m, double travelled_max_m) {
    Envelope& envelope =
        plan.steps[0].outcomes[static_cast<std::size_t>(Outcome::kContact)].envelope;
    envelope.travelled_min[0] = travelled_min_m;
    envelope.travelled_max[0] = travelled_max_m;
    envelope.possible = kAllContacts;
    return certify(encode_plan(plan), task, pool);
  };
  EXPECT_TRUE(certified(0.0, 1.0).holds());
  // Both end at the goal, whatever the envelope says: the first of them by the shorter way.
  const double nominal_m = 0.5 - start.pose.position_m.x();
  const Certification first = certified(nominal_m, 1.0);
  ASSERT_FALSE(first.holds());
  EXPECT_EQ(first.refuting()->disagreement.particle, 0U);
  const Certification second = certified(0.0, nominal_m);
  ASSERT_FALSE(second.holds());
  EXPECT_EQ(second.refuting()->disagreement.particle, 1U);
}

TEST(Planner, CertificationRefusesAPlanOfAnotherTask) {
  Task task = room_task();
  const PlanReport report = planned(task);
  RolloutPool pool(WallRollout(room()), 1);
  task.starts.front().name = "b";
  EXPECT_THROW((void)certify(report.bytes, task, pool), InputError);
  task = room_task();
  task.starts.front().pose.position_m.x() += 0.01;
  EXPECT_THROW((void)certify(report.bytes, task, pool), InputError);
}

TEST(Planner, CertificationRefusesAPlanThatSaysAnotherGoalOrTolerance) {
  const Task task = room_task();
  const PlanReport report = planned(task);
  ASSERT_TRUE(report.plan.has_value());
  RolloutPool pool(WallRollout(room()), 1);
  Plan plan = *report.plan;
  plan.goal.position_m.x() += 0.1;
  EXPECT_THROW((void)certify(encode_plan(plan), task, pool), InputError);
  plan = *report.plan;
  plan.goal_tolerance_m *= 100.0;
  EXPECT_THROW((void)certify(encode_plan(plan), task, pool), InputError);
}

TEST(Planner, CertificationRefusesAPlanWithLimitsOrSpeedsThatItsTaskHasNot) {
  const Task task = room_task();
  const PlanReport report = planned(task);
  ASSERT_TRUE(report.plan.has_value());
  RolloutPool pool(WallRollout(room()), 1);
  Plan plan = *report.plan;
  plan.torque_limit_Nm *= 50.0;
  EXPECT_THROW((void)certify(encode_plan(plan), task, pool), InputError);
  plan = *report.plan;
  plan.parameter_sets.front().speeds.approach_mps *= 3.0;
  EXPECT_THROW((void)certify(encode_plan(plan), task, pool), InputError);
}

TEST(Planner, IsJudgedByDrawsThatItsSearchHasNotSeen) {
  const Task task = room_task();
  const PlanReport report = planned(task);
  ASSERT_TRUE(report.plan.has_value());
  RolloutPool pool(WallRollout(room()), 1);
  for (const std::uint64_t seed : {kSearchSeed, kEnvelopeSeed}) {
    const auto seen = drawn_starts(seed, 200, DrawnPhysics::kCorners, *report.plan, task,
                                   task.starts.front(), pool.front());
    for (const Draw& judging : report.validation.draws) {
      for (const JudgedStart& start : seen) {
        EXPECT_FALSE(judging.chain.start.pose == start.particle.pose);
      }
    }
  }
}

// A wall that stands elsewhere for a tilted start leaves it as uncertain as it was.
TEST(Planner, WhatNoPlanBearsOfTheTiltIsToldAndHalfOfItHeldOrNone) {
  Task task = room_task();
  task.tilt_rad = 2e-4;
  const std::uint64_t untilted = planned(room_task()).search_moves.rollouts;
  for (const double share : {1.0, 0.5, 0.0}) {
    WallRollout::World world = room();
    world.narrow_beyond_tilt_rad = (share + 0.01) * task.tilt_rad;
    PlannerOptions options;
    // What needs more than one round holds for each of the tilts.
    options.rounds_max = 2;
    const PlanReport report = planned(task, world, options);
    ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
    const Validation& validation = report.validation;
    EXPECT_EQ(validation.held.tilt_rad, share * task.tilt_rad);
    EXPECT_EQ(arrived(validation.corners), validation.corners.size());
    EXPECT_EQ(validation.at_goal() < validation.draws.size(), share < 1.0)
        << "draws have all of it";
    // From the file alone the same is found.
    RolloutPool pool(WallRollout(world), 1);
    const Validation again = validate(*report.plan, task, task.starts.front(), kDrawsMin, pool);
    EXPECT_EQ(again.held.tilt_rad, validation.held.tilt_rad);
    EXPECT_EQ(again.at_goal(), validation.at_goal());
    // It gives up in time, of half of the tilt later than of all: there is no end to looking for
    // walls that are not there.
    EXPECT_LT(report.search_moves.rollouts, (share > 0.0 ? 20 : 100) * untilted) << share;
  }
}

TEST(Planner, APlanThatDiesByTheArmsLatencyIsRefuted) {
  const Task task = room_task();
  const Plan plan = *planned(task).plan;
  WallRollout::World world = room();
  world.x_gain_late_mps = 1.0;  // 10 mm at the 10 ms that the plan allows
  RolloutPool pool(WallRollout(world), 1);
  const Certification certification = certify(encode_plan(plan), task, pool);
  for (const VariantRun& run : certification.runs) {
    if (run.variant.name == "no latency") {
      EXPECT_TRUE(run.holds);
    }
    if (run.variant.name == "longest latency") {
      EXPECT_FALSE(run.holds);
    }
  }
  EXPECT_EQ(certification.runs.size(), 6U);
  // No way ends within the tolerance with and without so much.
  const PlanReport report = planned(task, world);
  EXPECT_NE(report.status, PlanStatus::kPlanned);
  EXPECT_FALSE(report.refusals.empty());
  // On a cell that is at once nothing refutes the first path.
  PlannerOptions at_once;
  at_once.assumptions = CellAssumptions{5e4, 0.0};
  EXPECT_TRUE(planned(task, world, at_once).refusals.empty());
}

TEST(Planner, PhysicsThatChangesAtHalfTheStepIsRefutedAndSearchedAround) {
  const Task task = room_task();
  WallRollout::World world = room();
  world.x_gain_at_short_step = 1.1;
  world.short_step_us = task.rollout_step_us;
  PlannerOptions options;
  options.rounds_max = 4;
  const PlanReport report = planned(task, world, options);
  EXPECT_EQ(report.status, PlanStatus::kNotCertified);
  ASSERT_EQ(report.refusals.size(), 4U);
  EXPECT_NE(report.refusals[0].find("half the integration step"), std::string::npos);
  EXPECT_FALSE(report.plan.has_value());
}

TEST(Planner, AStartOrGoalInCollisionIsNamed) {
  const auto reason = [](const Task& task) {
    const PlanReport report = planned(task);
    EXPECT_EQ(report.status, PlanStatus::kInCollision);
    return report.reason;
  };
  Task task = room_task();
  task.starts.front().pose.position_m.x() = -0.6;
  EXPECT_NE(reason(task).find("at (-0.6"), std::string::npos);
  // A particle in the wall is enough.
  task.starts.front().pose.position_m.x() = -0.46;
  EXPECT_NE(reason(task).find("2 standard deviations out"), std::string::npos);
  task.starts.front().pose.position_m.x() = -0.43;
  WallRollout rollout(room());
  EXPECT_EQ(collision(task, task.starts.front(), rollout), "");
  task.goal.position_m.x() = -0.6;
  EXPECT_NE(reason(task).find("the goal of task"), std::string::npos);
}

TEST(Planner, AnUnreachableGoalExhaustsTheGraph) {
  Task task = room_task();
  task.coordinates = 0b01;  // the goal's y is out of reach
  task.starts.front().sigma[1] = 0.0;
  const PlanReport report = planned(task);
  EXPECT_EQ(report.status, PlanStatus::kExhausted) << report.reason;
}

TEST(Planner, NoAttractorIsSaidSo) {
  // Nothing to touch within reach of any push; a corridor far away keeps the graph finite.
  Task task = room_task();
  task.coordinates = 0b01;
  task.starts.front().sigma[1] = 0.0;
  task.long_step_m = 0.05;
  EXPECT_EQ(planned(task).status, PlanStatus::kNoAttractor);
}

TEST(Planner, TheTimeLimitIsAReasonOfItsOwn) {
  const Task task = room_task();
  double now_s = 0.0;
  const PlanReport report =
      make_plan(task, task.starts.front(), WallRollout(room()), {}, [&] { return now_s += 20.0; });
  EXPECT_EQ(report.status, PlanStatus::kTimeLimit);
  EXPECT_NE(report.reason.find("60 s (raise --time-limit)"), std::string::npos) << report.reason;
  EXPECT_NE(report.reason.find("the nearest had all particles within "), std::string::npos);
}

TEST(Planner, TheTimeLimitHoldsForTheAttractorsToo) {
  const Task task = room_task();
  double now_s = 0.0;
  const PlanReport report =
      make_plan(task, task.starts.front(), WallRollout(room()), {}, [&] { return now_s += 61.0; });
  EXPECT_EQ(report.status, PlanStatus::kTimeLimit);
  EXPECT_EQ(report.guides, 0U);
}

TEST(Planner, TheExpansionLimitIsAReasonOfItsOwn) {
  PlannerOptions options;
  options.expansions_max = 2;
  EXPECT_EQ(planned(room_task(), room(), options).status, PlanStatus::kExpansionLimit);
}

TEST(Planner, AStartAtTheGoalNeedsNoPlan) {
  Task task = room_task();
  task.starts.front().sigma.setZero();
  task.starts.front().pose = task.goal;
  EXPECT_EQ(planned(task).status, PlanStatus::kAlreadyAtGoal);
}

TEST(Planner, AFreeStepRunsFastAndAContactIsMetSlowly) {
  const PlanReport report = planned(room_task());
  ASSERT_EQ(report.status, PlanStatus::kPlanned);
  for (std::size_t i = 0; i < report.plan->steps.size(); ++i) {
    const Step& step = report.plan->steps[i];
    for (const Draw& draw : report.validation.draws) {
      if (draw.chain.moves[i].outcome == Outcome::kReached) continue;
      EXPECT_GE(draw.chain.moves[i].travelled.norm(), step.slow_from_m);
    }
  }
  EXPECT_NEAR(report.plan->steps.back().slow_from_m, report.plan->steps.back().displacement.norm(),
              1e-6);
}

}  // namespace
}  // namespace tenon::planner
