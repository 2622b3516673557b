// The baselines that know one particle only, on the exact double.

#include "planner/search/contact_greedy.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "planner/planner.h"
#include "planner/report/statistics.h"
#include "planner/report/summary.h"
#include "shared/plan/codec.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

PlanReport planned(const Task& task, PlanMethod method, const WallRollout::World& world = room(),
                   std::size_t expansions_max = 5000) {
  PlannerOptions options;
  options.method = method;
  options.expansions_max = expansions_max;
  return make_plan(task, task.starts.front(), WallRollout(world), options, [] { return 0.0; });
}

/// The moves of the nominal start; its first contact is where a signature first has a bit.
std::size_t first_contact(const PlanReport& report) {
  const auto& moves = report.certification.runs.front().chains.front().moves;
  const auto found = std::find_if(moves.begin(), moves.end(),
                                  [](const auto& move) { return move.signature.count() > 0; });
  return static_cast<std::size_t>(found - moves.begin());
}

ContactSignature first_touched(const PlanReport& report) {
  return report.certification.runs.front().chains.front().moves[first_contact(report)].signature;
}

TEST(Baselines, SingleParticleGoesStraightAndIsPoorAtTheRealStarts) {
  const Task task = room_task();
  const PlanReport ours = planned(task, PlanMethod::kMha);
  const PlanReport single = planned(task, PlanMethod::kSingleParticle);
  ASSERT_EQ(ours.status, PlanStatus::kPlanned) << ours.reason;
  ASSERT_EQ(single.status, PlanStatus::kPlanned) << single.reason;
  EXPECT_LT(single.plan->steps.size(), ours.plan->steps.size());
  EXPECT_LT(single.expansions, ours.expansions);
  EXPECT_EQ(first_contact(single), single.plan->steps.size()) << "it has no reason to touch";
  // A disc of 2 mm about the goal, a start of 30 mm in both directions: 1 - exp(-1/450) of them.
  EXPECT_EQ(single.plan->draws, 200U);
  EXPECT_LE(single.plan->draws_at_goal, 5U);
  EXPECT_GE(ours.plan->draws_at_goal, 190U);
}

TEST(Baselines, ContactGreedyTouchesTheNearestWallBeforeAnythingElse) {
  Task task = room_task();
  // The wall at -x is 0.27 m away, that at -y 0.29 m: three steps to either of them.
  const PlanReport greedy = planned(task, PlanMethod::kContactGreedy);
  ASSERT_EQ(greedy.status, PlanStatus::kPlanned) << greedy.reason;
  EXPECT_EQ(first_contact(greedy), 2U);
  EXPECT_EQ(first_touched(greedy).bits, ContactSignature::bit(0, +1));
  EXPECT_LT(first_contact(greedy), first_contact(planned(task, PlanMethod::kSingleParticle)));

  task.starts.front().pose.position_m.y() = -0.15;
  const PlanReport other = planned(task, PlanMethod::kContactGreedy);
  ASSERT_EQ(other.status, PlanStatus::kPlanned) << other.reason;
  EXPECT_EQ(first_touched(other).bits, ContactSignature::bit(1, +1));
}

TEST(Baselines, OneWallMakesTheStartCertainInOneDirectionOnly) {
  const Task task = room_task();
  const PlanReport greedy = planned(task, PlanMethod::kContactGreedy);
  ASSERT_EQ(greedy.status, PlanStatus::kPlanned);
  std::size_t x_right = 0;
  for (const Draw& draw : greedy.validation.draws) {
    const bool touched =
        std::any_of(draw.chain.moves.begin(), draw.chain.moves.begin() + 3,
                    [](const GuardedMove::Result& move) { return move.signature.sign(0) > 0; });
    const double off_m = draw.chain.end().position_m.x() - task.goal.position_m.x();
    if (touched && std::abs(off_m) < 1e-6) ++x_right;
  }
  // Three steps reach the wall from all but the starts beyond one sigma on the far side.
  EXPECT_GT(x_right, 150U);
  EXPECT_LT(greedy.plan->draws_at_goal, 40U);
}

TEST(Baselines, CheckNoEnvelopeAndGoOnFromEveryOutcomeButATimeout) {
  for (const PlanMethod method : {PlanMethod::kSingleParticle, PlanMethod::kContactGreedy}) {
    const PlanReport report = planned(room_task(), method);
    ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
    EXPECT_EQ(report.plan->method, method);
    EXPECT_FALSE(report.plan->check_envelopes);
    for (std::size_t i = 0; i < report.plan->steps.size(); ++i) {
      const Step& step = report.plan->steps[i];
      const bool last = i + 1 == report.plan->steps.size();
      for (const Outcome outcome : kOutcomes) {
        Successor next = last ? kSuccessorDone : static_cast<Successor>(i + 1);
        if (outcome == Outcome::kTimeout) next = kSuccessorFail;
        EXPECT_EQ(step.rule(outcome).successor, next) << i << ' ' << to_string(outcome);
      }
      EXPECT_EQ(step.slow_from_m, 0.0) << "nobody knows where others will touch";
    }
  }
}

TEST(Baselines, CertifyAgainFromTheirBytesForTheirOneParticle) {
  const Task task = room_task();
  RolloutPool pool(WallRollout(room()), 1);
  for (const PlanMethod method : {PlanMethod::kSingleParticle, PlanMethod::kContactGreedy}) {
    const PlanReport report = planned(task, method);
    const Certification again = certify(report.bytes, task, pool);
    EXPECT_TRUE(again.holds());
    EXPECT_EQ(again.runs.size(), 2U) << "no friction but the nominal one";
    for (const VariantRun& run : again.runs) {
      ASSERT_EQ(run.chains.size(), 1U);
      EXPECT_EQ(run.chains.front().start.pose, task.starts.front().pose);
    }
    EXPECT_EQ(again.cost, report.plan->cost);
    // The belief's particles do not reach the goal by it.
    Plan claimed = *report.plan;
    claimed.method = PlanMethod::kMha;
    EXPECT_FALSE(certify(encode_plan(claimed), task, pool).holds());
  }
}

TEST(Baselines, SingleParticleIsBoundedAndContactGreedyClaimsNoBound) {
  const Task task = room_task();
  const PlanReport single = planned(task, PlanMethod::kSingleParticle);
  EXPECT_GE(single.plan->bound, 1.0);
  EXPECT_LE(single.plan->bound, task.w1);
  const PlanReport greedy = planned(task, PlanMethod::kContactGreedy);
  EXPECT_EQ(greedy.plan->bound, 0.0);
  EXPECT_GT(greedy.plan->cost, single.plan->cost);
}

TEST(Baselines, WhereNothingCanBeTouchedContactGreedySpendsItsBudget) {
  Task task = room_task();
  task.goal.position_m = {0.17, 0.09, 0.0};
  EXPECT_EQ(planned(task, PlanMethod::kSingleParticle, {}, 50).status, PlanStatus::kPlanned);
  const PlanReport greedy = planned(task, PlanMethod::kContactGreedy, {}, 50);
  EXPECT_EQ(greedy.status, PlanStatus::kExpansionLimit);
  EXPECT_EQ(greedy.expansions, 50U);
}

TEST(Baselines, TheBudgetIsThatOfBothSearchesTogether) {
  const Task task = room_task();
  const std::size_t needed = planned(task, PlanMethod::kContactGreedy).expansions;
  EXPECT_EQ(planned(task, PlanMethod::kContactGreedy, room(), needed).status, PlanStatus::kPlanned);
  const PlanReport short_of_one = planned(task, PlanMethod::kContactGreedy, room(), needed - 1);
  EXPECT_EQ(short_of_one.status, PlanStatus::kExpansionLimit);
  EXPECT_EQ(short_of_one.expansions, needed - 1);
}

TEST(Baselines, TheStatisticsNameTheMethodAndTheEstimateWithinTheParticlesReach) {
  const Task task = room_task();
  const PlanReport greedy = planned(task, PlanMethod::kContactGreedy);
  const std::string json = statistics_json(greedy, task);
  EXPECT_NE(json.find("\"method\": \"contact-greedy\""), std::string::npos);
  EXPECT_NE(json.find("\"draws_within_particles_at_goal\""), std::string::npos);
  const std::string text = summary(greedy, task, "plan.tnp");
  EXPECT_NE(text.find("method contact-greedy"), std::string::npos);
  EXPECT_NE(text.find("no bound proven"), std::string::npos);
  EXPECT_NE(text.find("within 2 sigma"), std::string::npos);
}

}  // namespace
}  // namespace tenon::planner
