// Successors, primitives, heuristics and attractors on the exact double.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "planner/attractors.h"
#include "planner/belief_graph.h"
#include "planner/plan_builder.h"
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
  const auto direct = direct_primitive(task, mean);
  ASSERT_TRUE(direct.has_value());
  EXPECT_EQ(direct->displacement.x(),
            static_cast<double>(static_cast<float>(0.1 + 1.0 / 3.0 * 0.1)));
}

TEST_F(Room, TheDirectMoveExistsWithinReachOnlyAndStaysInTheSearchedCoordinates) {
  Pose mean = task.goal;
  mean.position_m.x() += task.direct_reach_m + 1e-3;
  EXPECT_FALSE(direct_primitive(task, mean).has_value());
  mean.position_m.x() -= 2e-3;
  mean.position_m.z() += 0.5;
  const auto direct = direct_primitive(task, mean);
  ASSERT_TRUE(direct.has_value());
  EXPECT_EQ(direct->displacement.z(), 0.0);
  EXPECT_FALSE(direct_primitive(task, task.goal).has_value());
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

TEST_F(Room, ARefusedEdgeIsGone) {
  BeliefGraph graph(task, start, {}, succ);
  const auto before = graph.successors(0);
  graph.refuse(0, before.front().label);
  const auto after = graph.successors(0);
  EXPECT_EQ(after.size() + 1, before.size());
  for (const Edge& edge : after) EXPECT_NE(edge.label, before.front().label);
}

TEST_F(Room, AttractorsAreTheWallsAndCornersAndEachStandsOnce) {
  const auto attractors = find_attractors(task, start, succ, pool.front());
  ASSERT_FALSE(attractors.empty());
  ASSERT_LE(attractors.size(), 8U);
  for (std::size_t i = 0; i < attractors.size(); ++i) {
    const Vector3& p = attractors[i].contact.position_m;
    EXPECT_TRUE(std::abs(std::abs(p.x()) - 0.5) < 1e-9 || std::abs(std::abs(p.y()) - 0.4) < 1e-9);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT((attractors[j].contact.position_m - p).norm(), 0.5 * task.step_m - 1e-12);
    }
  }
}

TEST_F(Room, WithoutWallsThereIsNoAttractor) {
  RolloutPool empty(WallRollout(WallRollout::World{}), 1);
  SuccessorEngine engine(empty, MoveParameters{}, 2000);
  EXPECT_TRUE(find_attractors(task, start, engine, empty.front()).empty());
}

TEST_F(Room, TheFoliatedHeuristicLeadsToTheContactWhileUncertainAndThenToTheGoal) {
  const Attractor attractor{Pose{{0.5, 0.0, 0.0}, Eigen::Quaterniond::Identity()}, task.goal};
  const BeliefSummary uncertain = summarise(start, task);
  EXPECT_NEAR(foliated_heuristic(uncertain, attractor, task),
              5e3 * std::hypot(0.5 + 0.23, 0.11) + 2.5e6 * 0.0036, 1e-6);
  BeliefSummary certain = uncertain;
  certain.uncertainty_m2 = task.goal_uncertainty_m2;
  EXPECT_NEAR(foliated_heuristic(certain, attractor, task),
              5e3 * std::hypot(0.40, 0.23) + 2.5e6 * 2e-6, 1e-6);
}

}  // namespace
}  // namespace tenon::planner
