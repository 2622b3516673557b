// Successors, primitives, heuristics and attractors on the exact double.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "planner/search/attractors.h"
#include "planner/search/belief_graph.h"
#include "planner/search/heuristics.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

class Room : public testing::Test {
 protected:
  Task task = room_task();
  RolloutPool pool{WallRollout(room()), 2};
  SuccessorEngine succ{pool, MoveParameters{}, 2000};
  Belief start = cross_polytope(task, task.starts.front());
};

TEST_F(Room, EveryParticleMovesToItsOwnOutcome) {
  Primitive left;
  left.displacement.x() = -0.25;
  const auto ends = succ.successors(start, std::array{left});
  ASSERT_TRUE(ends[0].has_value());
  const auto& p = ends[0]->particles;
  EXPECT_DOUBLE_EQ(p[0].pose.position_m.x(), -0.17 - 0.25);
  EXPECT_EQ(p[0].signature.count(), 0);
  EXPECT_DOUBLE_EQ(p[1].pose.position_m.x(), -0.5);
  EXPECT_TRUE(p[1].signature.has(0, +1));
  EXPECT_EQ(p[1].physics.friction, start.particles[1].physics.friction);
}

TEST_F(Room, ARolloutIsSimulatedOnce) {
  const std::vector<Primitive> steps = step_primitives(task);
  (void)succ.successors(start, steps);
  EXPECT_EQ(succ.counters().rollouts, 16U);
  EXPECT_EQ(succ.counters().memo_hits, 0U);
  (void)succ.successors(start, steps);
  EXPECT_EQ(succ.counters().rollouts, 16U);
  EXPECT_EQ(succ.counters().memo_hits, 16U);
}

TEST_F(Room, APlainTouchIsAnotherMoveThanAPress) {
  const Primitive press = step_primitives(task).front();
  Primitive plain = press;
  plain.plain = true;
  (void)succ.successors(start, std::array{press, plain});
  EXPECT_EQ(succ.counters().rollouts, 8U);
  // What refutes a press says nothing of the plain one.
  succ.refuse(start.particles.front(), press.displacement);
  const auto ends = succ.successors(start, std::array{press, plain});
  EXPECT_FALSE(ends[0].has_value());
  EXPECT_TRUE(ends[1].has_value());
}

TEST_F(Room, CoincidentParticlesAreSimulatedOnceAndOthersAreNot) {
  Particle one = start.particles.front();
  Particle other = one;
  other.pose.position_m.x() += 1e-7;
  Particle slippery = one;
  slippery.physics.friction = 0.9;
  Particle pressed = one;
  pressed.signature.bits = ContactSignature::bit(1, +1);
  (void)succ.successors(Belief{{one, other, slippery, pressed}},
                        std::array{step_primitives(task).front()});
  EXPECT_EQ(succ.counters().rollouts, 3U);
  EXPECT_EQ(succ.counters().memo_hits, 1U);
}

TEST_F(Room, BrokenPhysicsIsNoEdgeAndTheOthersStand) {
  WallRollout::World world = room();
  world.broken_beyond_x_m = -0.18;  // one of the four particles stands beyond
  RolloutPool broken(WallRollout(world), 1);
  SuccessorEngine engine(broken, MoveParameters{}, 2000);
  EXPECT_FALSE(engine.successors(start, std::array{step_primitives(task).front()})[0].has_value());
  EXPECT_EQ(engine.counters().failures, 1U);
  const Belief certain{{start.particles[1]}};
  EXPECT_TRUE(engine.successors(certain, std::array{step_primitives(task).front()})[0].has_value());
}

TEST_F(Room, PrimitivesAreValuesThatAFileHolds) {
  for (const Primitive& p : step_primitives(task))
    EXPECT_EQ(p.displacement, stored(p.displacement));
  Pose mean = task.goal;
  mean.position_m.x() -= 0.1 + 1.0 / 3.0 * 0.1;
  const auto direct = direct_primitive(task, mean, task.goal);
  ASSERT_TRUE(direct.has_value());
  EXPECT_EQ(direct->displacement.x(),
            static_cast<double>(static_cast<float>(0.1 + 1.0 / 3.0 * 0.1)));
}

TEST_F(Room, TheDirectMoveExistsWithinReachOnlyAndStaysInTheSearchedCoordinates) {
  Pose mean = task.goal;
  mean.position_m.x() += task.direct_reach_m + 1e-3;
  EXPECT_FALSE(direct_primitive(task, mean, task.goal).has_value());
  mean.position_m.x() -= 2e-3;
  mean.position_m.z() += 0.5;
  const auto direct = direct_primitive(task, mean, task.goal);
  ASSERT_TRUE(direct.has_value());
  EXPECT_EQ(direct->displacement.z(), 0.0);
  EXPECT_FALSE(direct_primitive(task, task.goal, task.goal).has_value());
}

TEST_F(Room, TheAnchorIsConsistentOnEveryGeneratedEdge) {
  BeliefGraph graph(task, start, {}, succ);
  std::size_t edges = 0;
  for (StateId state = 0; state < std::min<std::size_t>(graph.size(), 300); ++state) {
    for (const Edge& edge : graph.successors(state)) {
      ++edges;
      ASSERT_GE(edge.cost, 0.0);
      ASSERT_LE(graph.heuristic(0, state), edge.cost + graph.heuristic(0, edge.to) + 1e-9)
          << state << " -> " << edge.to;
    }
    if (graph.is_goal(state)) {
      EXPECT_EQ(graph.heuristic(0, state), 0.0);
    }
  }
  EXPECT_GT(edges, 1000U);
}

TEST_F(Room, ARefusedMoveOfOneParticleTakesItsEdgeAway) {
  BeliefGraph graph(task, start, {}, succ);
  const auto before = graph.successors(0);
  const int label = before.front().label;
  succ.refuse(start.particles[2], graph.displacement(0, label));
  const auto after = graph.successors(0);
  EXPECT_EQ(after.size() + 1, before.size());
  for (const Edge& edge : after) EXPECT_NE(edge.label, label);
}

TEST_F(Room, GuidesLeadToOneWallAfterTheOtherAndNoneStandsTwice) {
  const std::vector<Guide> guides = find_attractors(task, start, succ, pool.front()).guides;
  ASSERT_EQ(guides.size(), 2U);
  for (const Guide& guide : guides) {
    ASSERT_EQ(guide.contacts.size(), 2U);
    EXPECT_NE(guide.contacts[0].axis, guide.contacts[1].axis);
    for (const ContactAttractor& contact : guide.contacts) {
      const double wall_m = contact.axis == 0 ? 0.5 : 0.4;
      EXPECT_NEAR(std::abs(contact.mean.position_m[contact.axis]), wall_m, 1e-9);
      EXPECT_NEAR(contact.spread, 0.0, 1e-9);
    }
    EXPECT_NEAR(guide.contacts[0].uncertainty_m2, 0.0018, 1e-9);
    EXPECT_NEAR(guide.contacts[1].uncertainty_m2, 0.0, 1e-9);
    EXPECT_EQ(guide.goals.back().position_m, task.goal.position_m);
  }
  const auto walls = [](const Guide& guide) {
    return std::pair(guide.contacts[0].mean.position_m[guide.contacts[0].axis],
                     guide.contacts[1].mean.position_m[guide.contacts[1].axis]);
  };
  EXPECT_NE(walls(guides[0]), walls(guides[1]));
}

TEST_F(Room, AGuideBeginsWithinReachOfTheAnchor) {
  // Beyond w2 times the anchor's key a guide is never asked.
  const BeliefSummary seed = summarise(start, task);
  for (const Guide& guide : find_attractors(task, start, succ, pool.front()).guides) {
    EXPECT_LE(foliated_heuristic(seed, guide, task), task.w2 * anchor_heuristic(seed, task));
    EXPECT_GT(foliated_heuristic(seed, guide, task), anchor_heuristic(seed, task));
  }
}

TEST_F(Room, WithoutWallsThereIsNoAttractor) {
  RolloutPool empty(WallRollout(WallRollout::World{}), 1);
  SuccessorEngine engine(empty, MoveParameters{}, 2000);
  EXPECT_TRUE(find_attractors(task, start, engine, empty.front()).guides.empty());
}

TEST_F(Room, TheFoliatedHeuristicCountsTheContactsThatAreLeftAndThenTheWayToTheGoal) {
  // x +0.5 at 0.0036 m2 of uncertainty, then y -0.4 at half of it, then the goal.
  ContactAttractor first;
  first.axis = 0;
  first.mean.position_m = {0.5, 7.0, 0.0};
  first.uncertainty_m2 = 0.0018;
  ContactAttractor second;
  second.axis = 1;
  second.mean.position_m = {7.0, -0.4, 0.0};
  const Guide guide{{first, second}, {task.goal}, 0.5};

  // The farthest particles stand 0.06 m out: 0.79 m are eight steps, 0.35 m are four.
  BeliefSummary belief = summarise(start, task);
  const double contacts = 5e3 * 0.73 + 2.5e6 * 0.0036 * 8 + 5e3 * 0.29 + 2.5e6 * 0.0018 * 4;
  const double home = 5e3 * std::hypot(0.33, 0.52);
  EXPECT_NEAR(foliated_heuristic(belief, guide, task), 0.5 * contacts + home, 1e-6);

  // Whoever stands together along x has that contact behind it.
  belief.spread[0] = 0.0;
  belief.uncertainty_m2 = 0.0018;
  belief.mean.position_m.x() = 0.5;
  const double one_contact = 5e3 * 0.29 + 2.5e6 * 0.0018 * 4;
  EXPECT_NEAR(foliated_heuristic(belief, guide, task), 0.5 * one_contact + home, 1e-6);

  BeliefSummary certain = summarise(start, task);
  certain.spread.setZero();
  certain.uncertainty_m2 = task.goal_uncertainty_m2;
  EXPECT_NEAR(foliated_heuristic(certain, guide, task),
              5e3 * std::hypot(0.40, 0.23) + 2.5e6 * 2e-6 * 6.3, 1e-6);
}

}  // namespace
}  // namespace tenon::planner
