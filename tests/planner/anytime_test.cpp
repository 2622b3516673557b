// Better plans while a budget lasts: ever lower weights, and nothing that does not hold.

#include <gtest/gtest.h>

#include <vector>

#include "shared/plan/codec.h"
#include "tests/planner/room_plan.h"

namespace tenon::planner {
namespace {

struct Kept {
  std::vector<Plan> plans;
  PlanReport last;
};

Task greedy_room() {
  Task task = room_task();
  task.w1 = task.w2 = 4.0;
  return task;
}

Kept improved(const Task& task, double improve_s, const ClockSeconds& now_s = stopped_clock,
              const WallRollout::World& world = room()) {
  Kept kept;
  PlannerOptions options;
  options.improve_s = improve_s;
  options.planned = [&](const PlanReport& report) { kept.plans.push_back(*report.plan); };
  kept.last = make_plan(task, task.starts.front(), WallRollout(world), options, now_s);
  return kept;
}

TEST(Anytime, EachPlanIsCheaperOrCloserToTheOptimumAndTheLastHolds) {
  const Task task = greedy_room();
  const Kept kept = improved(task, 1.0);
  ASSERT_EQ(kept.last.status, PlanStatus::kPlanned) << kept.last.reason;
  ASSERT_GE(kept.plans.size(), 2U);
  for (std::size_t i = 1; i < kept.plans.size(); ++i) {
    const Plan& before = kept.plans[i - 1];
    const Plan& after = kept.plans[i];
    EXPECT_LE(after.cost, before.cost) << i;
    EXPECT_TRUE(after.cost < before.cost || after.bound < before.bound) << i;
  }
  // With weights of 1 the last is the best there is, and shows whether the others told the truth.
  EXPECT_EQ(kept.plans.back().bound, 1.0);
  for (const Plan& plan : kept.plans) {
    EXPECT_LE(plan.cost, plan.bound * kept.plans.back().cost * (1.0 + 1e-9));
  }
  EXPECT_EQ(kept.last.bytes, encode_plan(kept.plans.back()));
  EXPECT_EQ(kept.last.search.path.size(), kept.plans.back().steps.size());
  RolloutPool pool(WallRollout(room()), 1);
  EXPECT_TRUE(certify(kept.last.bytes, task, pool).holds());
  EXPECT_EQ(kept.last.validation.at_goal_within(2.0), kept.last.validation.within(2.0));
}

TEST(Anytime, WithoutABudgetTheFirstPlanIsTheSameByteForByte) {
  const Task task = greedy_room();
  const std::vector<std::uint8_t> alone = planned(task).bytes;
  const Kept without = improved(task, 0.0);
  EXPECT_EQ(without.plans.size(), 1U);
  EXPECT_EQ(without.last.bytes, alone);
  EXPECT_EQ(encode_plan(improved(task, 1.0).plans.front()), alone);
}

TEST(Anytime, ABudgetThatIsSpentAtOnceLeavesTheFirstPlan) {
  const Task task = greedy_room();
  double now_s = 0.0;
  const auto clock = [&] { return now_s += 1e-3; };
  const Kept kept = improved(task, 1e-3, clock);
  ASSERT_EQ(kept.last.status, PlanStatus::kPlanned) << kept.last.reason;
  EXPECT_EQ(kept.plans.size(), 1U);
  EXPECT_EQ(kept.last.bytes, planned(task).bytes);
}

TEST(Anytime, ACheaperPathThatDoesNotHoldIsNoPlan) {
  // The ledge refutes paths that push against the low wall.
  WallRollout::World world = room();
  world.ledge_m = 0.05;
  world.ledge_from_y_m = -0.095;
  world.ledge_to_y_m = -0.065;
  const Task task = greedy_room();
  const Kept kept = improved(task, 1.0, stopped_clock, world);
  ASSERT_EQ(kept.last.status, PlanStatus::kPlanned) << kept.last.reason;
  RolloutPool pool(WallRollout(world), 1);
  for (const Plan& plan : kept.plans) {
    EXPECT_TRUE(certify(encode_plan(plan), task, pool).holds());
    const Validation again = validate(plan, task, task.starts.front(), plan.draws, pool);
    EXPECT_EQ(arrived(again.corners), again.corners.size());
  }
}

}  // namespace
}  // namespace tenon::planner
