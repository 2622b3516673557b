// Which touches of a plan press the part flat: those that settle how it is turned.

#include "planner/judge/plain_touches.h"

#include <gtest/gtest.h>

#include <vector>

#include "planner/judge/plan_draft.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

class PlainTouches : public ::testing::Test {
 protected:
  PlainTouches() {
    task.coordinates = 0b100011;
    task.compliance.compliant_axes = 0b100011;
  }

  /// Two touches by a part before an environment that is turned by so much. Each leaves it turned,
  /// as the environment sees it, by what is given.
  [[nodiscard]] Chain turned(double environment_rad, double first_rad, double second_rad) const {
    Chain chain;
    chain.start.environment = {Vector3::Zero(), rotation_of({0.0, 0.0, environment_rad})};
    chain.start.pose = task.goal;
    for (const double seen_rad : {first_rad, second_rad}) {
      GuardedMove::Result move;
      move.outcome = Outcome::kContact;
      move.pose = {task.goal.position_m,
                   rotation_of({0.0, 0.0, environment_rad + seen_rad}) * task.goal.orientation};
      chain.moves.push_back(move);
      chain.steps.push_back(chain.steps.size());
    }
    return chain;
  }
  [[nodiscard]] Plan draft() const {
    const std::vector<Vector6> displacements = {Vector6::Unit(0) * 0.05, Vector6::Unit(1) * 0.05};
    return draft_plan(task, task.starts.front(), {}, displacements);
  }

  Task task = room_task();
};

TEST_F(PlainTouches, AreThoseAfterWhichThePartIsTurnedAsUncertainlyAsBefore) {
  const std::vector<Chain> chains = {turned(0.05, 0.001, 0.002), turned(-0.04, 0.0, 0.001),
                                     turned(0.0, 0.0, 0.001)};
  const auto plan = with_plain_touches(draft(), chains);
  ASSERT_TRUE(plan.has_value());
  EXPECT_TRUE(move_parameters(*plan, 0).aligns);
  EXPECT_FALSE(move_parameters(*plan, 1).aligns);
}

TEST_F(PlainTouches, NothingChangesWhereEveryTouchSettlesARotationOrNoneYields) {
  const std::vector<Chain> chains = {turned(0.05, 0.01, 0.001), turned(-0.05, -0.01, 0.0)};
  EXPECT_FALSE(with_plain_touches(draft(), chains).has_value());
  task.compliance.compliant_axes = 0b000011;
  const std::vector<Chain> askew = {turned(0.05, -0.05, -0.05), turned(-0.05, 0.05, 0.05)};
  EXPECT_FALSE(with_plain_touches(draft(), askew).has_value());
}

TEST_F(PlainTouches, AreInADraftWhatTheWaySays) {
  const std::vector<Vector6> displacements = {Vector6::Unit(0) * 0.05, Vector6::Unit(1) * 0.05};
  const std::vector<std::size_t> plain = {1};
  const Plan as_told = draft_plan(task, task.starts.front(), {}, displacements, plain);
  EXPECT_TRUE(move_parameters(as_told, 0).aligns);
  EXPECT_FALSE(move_parameters(as_told, 1).aligns);
  // They stay so, whatever the other touches do.
  const std::vector<Chain> chains = {turned(0.05, 0.001, 0.002), turned(-0.04, 0.0, 0.001)};
  EXPECT_FALSE(with_plain_touches(as_told, chains).has_value());
}

TEST_F(PlainTouches, AMoveThatTouchesNothingStaysAsItIs) {
  std::vector<Chain> chains = {turned(0.05, -0.05, -0.05), turned(-0.05, 0.05, 0.05)};
  for (Chain& chain : chains) chain.moves[1].outcome = Outcome::kReached;
  const auto plan = with_plain_touches(draft(), chains);
  ASSERT_TRUE(plan.has_value());
  EXPECT_FALSE(move_parameters(*plan, 0).aligns);
  EXPECT_TRUE(move_parameters(*plan, 1).aligns);
}

}  // namespace
}  // namespace tenon::planner
