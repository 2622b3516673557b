// Where a plan's last move ends.

#include "planner/judge/last_move.h"

#include <gtest/gtest.h>

#include <vector>

#include "planner/judge/plan_draft.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

class LastMove : public ::testing::Test {
 protected:
  /// Two moves, of which the second came to rest beside the goal.
  [[nodiscard]] Chain ended(double off_x_m, double off_y_m) const {
    Chain chain;
    chain.moves.resize(2);
    chain.moves[1].outcome = Outcome::kReached;
    chain.moves[1].pose = task.goal;
    chain.moves[1].pose.position_m += Vector3(off_x_m, off_y_m, 0.0);
    chain.steps = {0, 1};
    chain.touching = {{"wall"}, {}};
    chain.done = true;
    return chain;
  }
  [[nodiscard]] Vector6 moved(const std::vector<Chain>& chains) const {
    const auto centred = with_last_move_centred(plan, chains, task);
    return centred ? Vector6(centred->steps[1].displacement - plan.steps[1].displacement)
                   : Vector6(Vector6::Zero());
  }

  const Task task = room_task();
  const std::vector<Vector6> displacements = {Vector6::Unit(1) * 0.05, Vector6::Unit(0) * 0.1};
  const Plan plan = draft_plan(task, task.starts.front(), {}, displacements);
  const double tolerance_m = task.goal_tolerance_m;
};

// The mean is to one side; who is farthest out counts.
TEST_F(LastMove, PutsTheMiddleOfAllEndsOnTheGoal) {
  const double t = tolerance_m;
  const Vector6 by = moved({ended(0.8 * t, 0.1 * t), ended(0.8 * t, 0.1 * t), ended(0.2 * t, 0)});
  EXPECT_NEAR(by[0], -0.5 * t, 1e-8);
  EXPECT_NEAR(by[1], -0.05 * t, 1e-8);
  EXPECT_EQ(by.tail<4>(), Vector6::Zero().tail<4>());
}

TEST_F(LastMove, StaysWhereLittleIsGainedOrSomethingIsTouched) {
  EXPECT_EQ(moved({ended(0.09 * tolerance_m, 0.0)}), Vector6::Zero());
  EXPECT_NE(moved({ended(0.11 * tolerance_m, 0.0)}), Vector6::Zero());

  Chain touching = ended(0.5 * tolerance_m, 0.0);
  touching.touching[1] = {"wall"};
  EXPECT_EQ(moved({ended(0.5 * tolerance_m, 0.0), touching}), Vector6::Zero());

  Chain pushed = ended(0.5 * tolerance_m, 0.0);
  pushed.moves[1].outcome = Outcome::kContact;
  EXPECT_EQ(moved({pushed}), Vector6::Zero());
}

// A tool that was turned about z by contacts is turned about the other axes by rounding.
TEST_F(LastMove, ThatIsCarriedStaysWithinTheCoordinates) {
  Task turning = task;
  turning.coordinates = 0b100011;
  turning.motion.carried_axes = true;
  Plan turned = plan;
  turned.coordinates = turning.coordinates;
  Chain chain = ended(0.8 * tolerance_m, 0.0);
  chain.moves[1].pose.orientation =
      rotation_of({1e-17, 1e-17, 0.1}) * chain.moves[1].pose.orientation;
  const auto centred = with_last_move_centred(turned, std::vector<Chain>{chain}, turning);
  ASSERT_TRUE(centred);
  EXPECT_NE(centred->steps[1].displacement[0], plan.steps[1].displacement[0]);
  EXPECT_EQ(centred->steps[1].displacement[2], 0.0);
}

// All the way at approach speed remains all the way.
TEST_F(LastMove, KeepsHowFarItIsFast) {
  Plan fast = plan;
  fast.steps[1].slow_from_m = fast.steps[1].displacement.head<3>().norm();
  const std::vector<Chain> chains = {ended(0.5 * tolerance_m, 0.0)};
  const auto centred = with_last_move_centred(fast, chains, task);
  ASSERT_TRUE(centred);
  EXPECT_NEAR(centred->steps[1].slow_from_m, 0.1 - 0.5 * tolerance_m, 1e-8);
  fast.steps[1].slow_from_m = 0.03;
  EXPECT_NEAR(with_last_move_centred(fast, chains, task)->steps[1].slow_from_m, 0.03, 1e-8);
}

}  // namespace
}  // namespace tenon::planner
