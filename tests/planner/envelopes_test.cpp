// What a step's envelopes span.

#include "planner/judge/envelopes.h"

#include <gtest/gtest.h>

#include <vector>

#include "planner/judge/plan_draft.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

GuardedMove::Result result_of(Outcome outcome, double x_m, std::uint16_t bits = 0) {
  GuardedMove::Result result;
  result.outcome = outcome;
  result.travelled.x() = x_m;
  result.signature.bits = bits;
  return result;
}

Chain chain_of(const GuardedMove::Result& move) {
  Chain chain;
  chain.moves = {move};
  chain.steps = {0};
  return chain;
}

TEST(Envelopes, SpanWhatWasSeenAndTheMarginsAndNothingElse) {
  const Task task = room_task();
  const std::vector<Vector6> displacements = {Vector6::Unit(0) * 0.1};
  const Plan draft = draft_plan(task, task.starts.front(), {}, displacements);
  // 1 mm, 0.05 m/s * 10 ms, and 0.6 * 3 N / 1000 N/m.
  EXPECT_NEAR(envelope_margins(draft, task).position_m, 1e-3 + 0.5e-3 + 1.8e-3, 1e-8);

  const std::vector<Chain> contacts = {chain_of(result_of(Outcome::kContact, 0.04, 0b0010)),
                                       chain_of(result_of(Outcome::kContact, 0.06, 0b0110))};
  const Plan plan = with_envelopes(draft, task, contacts);
  const OutcomeRule& rule = plan.steps[0].rule(Outcome::kContact);
  EXPECT_NEAR(rule.envelope.travelled_min[0], 0.04 - 3.3e-3, 1e-8);
  EXPECT_NEAR(rule.envelope.travelled_max[0], 0.06 + 3.3e-3, 1e-8);
  EXPECT_EQ(rule.envelope.always.bits, 0b0010);
  EXPECT_EQ(rule.envelope.possible.bits, 0b0110);
  EXPECT_EQ(rule.envelope.travelled_max[2], 0.0);
  EXPECT_EQ(plan.steps[0].rule(Outcome::kReached).successor, kSuccessorFail);
}

TEST(Envelopes, WhereSomeMissedTheContactItMayComeAnywhereUpToTheWholeWay) {
  const Task task = room_task();
  const std::vector<Vector6> displacements = {Vector6::Unit(0) * 0.1};
  const Plan draft = draft_plan(task, task.starts.front(), {}, displacements);
  const std::vector<Chain> chains = {chain_of(result_of(Outcome::kContact, 0.04)),
                                     chain_of(result_of(Outcome::kReached, 0.10))};
  const Plan plan = with_envelopes(draft, task, chains);
  EXPECT_GT(plan.steps[0].rule(Outcome::kContact).envelope.travelled_max[0], 0.10);
  EXPECT_GT(plan.steps[0].rule(Outcome::kReached).envelope.travelled_min[0], 0.09);
}

/// A touch that turned the part by as much, in an environment that is turned by as much.
Chain turned_chain(double part_rad, double environment_rad) {
  GuardedMove::Result move = result_of(Outcome::kContact, 0.04, 0b0010);
  move.travelled[5] = part_rad;
  Chain chain = chain_of(move);
  chain.start.environment.orientation = rotation_of({0.0, 0.0, environment_rad});
  return chain;
}

/// The largest angle that a plan lets such touches turn a part by.
double most_turned_rad(double part_rad, bool aligns) {
  Task task = room_task();
  task.coordinates = 0b100001;
  const std::vector<Vector6> displacements = {Vector6::Unit(0) * 0.1};
  Plan draft = draft_plan(task, task.starts.front(), {}, displacements);
  draft.parameter_sets.front().aligns = aligns;
  const std::vector<Chain> chains = {turned_chain(part_rad, 0.08), turned_chain(0.0, -0.02)};
  const Plan plan = with_envelopes(draft, task, chains);
  return plan.steps[0].rule(Outcome::kContact).envelope.travelled_max[5];
}

TEST(Envelopes, APressThatTurnsThePartMayTurnItByMore) {
  Task task = room_task();
  task.coordinates = 0b100001;
  const std::vector<Vector6> displacements = {Vector6::Unit(0) * 0.1};
  const Plan draft = draft_plan(task, task.starts.front(), {}, displacements);
  const double margin_rad = envelope_margins(draft, task).angle_rad;
  const double turned_rad = 2.0 * margin_rad;
  EXPECT_NEAR(most_turned_rad(turned_rad, true), turned_rad + margin_rad + 0.08, 1e-6);
  // Who lies flat already shows it by not being turned, and who does not press turns nothing.
  EXPECT_NEAR(most_turned_rad(0.5 * margin_rad, true), 1.5 * margin_rad, 1e-6);
  EXPECT_NEAR(most_turned_rad(turned_rad, false), turned_rad + margin_rad, 1e-6);
}

// What the first press has left on an arm.
TEST(Envelopes, APressMakesGoodWhatAnEarlierOneHasLeft) {
  Task task = room_task();
  task.coordinates = 0b100001;
  const std::vector<Vector6> displacements(3, Vector6::Unit(0) * 0.1);
  const Plan draft = draft_plan(task, task.starts.front(), {}, displacements);
  const double margin_rad = envelope_margins(draft, task).angle_rad;
  Chain chain = turned_chain(0.0, 0.08);
  const GuardedMove::Result flat = chain.moves.front();
  chain.moves.push_back(turned_chain(2.0 * margin_rad, 0.08).moves.front());
  chain.moves.push_back(flat);
  chain.steps = {0, 1, 2};
  const Plan plan = with_envelopes(draft, task, std::vector<Chain>{chain});
  const auto most_rad = [&](std::size_t step) {
    return plan.steps[step].rule(Outcome::kContact).envelope.travelled_max[5];
  };
  EXPECT_NEAR(most_rad(0), margin_rad, 1e-6);
  EXPECT_NEAR(most_rad(1), 3.0 * margin_rad + 0.08, 1e-6);
  EXPECT_NEAR(most_rad(2), margin_rad + 0.08, 1e-6);
}

}  // namespace
}  // namespace tenon::planner
