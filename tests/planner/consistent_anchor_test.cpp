// The anchor is consistent on every edge that a search of beliefs generates: the bound rests on it.

#include <gtest/gtest.h>

#include "planner/search/attractors.h"
#include "planner/search/belief_graph.h"
#include "planner/search/heuristics.h"
#include "planner/search/mha_search.h"
#include "shared/config/load.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "tests/planner/room_task.h"
#include "tests/support/places.h"

namespace tenon::planner {
namespace {

/// Passes everything on, and looks at every edge on its way.
class WatchedGraph final : public SearchGraph {
 public:
  explicit WatchedGraph(BeliefGraph& graph) : graph_(graph) {}

  [[nodiscard]] StateId start() const override { return graph_.start(); }
  [[nodiscard]] bool is_goal(StateId state) const override { return graph_.is_goal(state); }
  [[nodiscard]] std::size_t inadmissible_count() const override {
    return graph_.inadmissible_count();
  }
  [[nodiscard]] double heuristic(std::size_t v, StateId state) const override {
    return graph_.heuristic(v, state);
  }
  [[nodiscard]] std::vector<Edge> successors(StateId state) override {
    const std::vector<Edge> edges = graph_.successors(state);
    for (const Edge& edge : edges) {
      const double h = heuristic(0, state);
      EXPECT_LE(h, edge.cost + heuristic(0, edge.to) + 1e-9 * h) << state << " -> " << edge.to;
      EXPECT_GE(edge.cost, 0.0);
      if (is_goal(edge.to)) {
        EXPECT_EQ(heuristic(0, edge.to), 0.0);
      }
    }
    edges_ += edges.size();
    return edges;
  }
  [[nodiscard]] std::size_t edges() const { return edges_; }

 private:
  BeliefGraph& graph_;
  std::size_t edges_ = 0;
};

/// Searches from the task's first start. @return how many edges were looked at
std::size_t watched_search(const Task& task, const Rollout& physics, std::size_t expansions) {
  RolloutPool pool(physics, 2);
  MoveParameters move;
  move.compliance = task.compliance;
  SuccessorEngine succ(pool, move, task.rollout_step_us);
  const Belief start = cross_polytope(task, task.starts.front());
  BeliefGraph graph(task, start, find_attractors(task, start, succ, pool.front()), succ);
  WatchedGraph watched(graph);
  (void)mha_search(watched, {task.w1, task.w2, expansions}, [] { return false; });
  return watched.edges();
}

TEST(ConsistentAnchor, InARoom) {
  EXPECT_GT(watched_search(room_task(), WallRollout(room()), 500), 40U);
}

TEST(ConsistentAnchor, IsTheStraightWayThatIsLeft) {
  const Task task = room_task();
  const auto at = [&](double away_m) {
    Particle particle;
    particle.pose = displaced(task.goal, away_m * Vector6::Unit(1));
    return anchor_heuristic(summarise({{particle}}, task), task);
  };
  EXPECT_EQ(at(0.0), 0.0);
  EXPECT_NEAR(at(0.1 + task.goal_tolerance_m), 0.1 * task.distance_weight_per_m, 1e-9);
  EXPECT_LT(at(0.1), at(0.2));
}

TEST(ConsistentAnchor, WithLooseTolerances) {
  Task task = room_task();
  task.goal_tolerance_m = 0.06;
  task.goal_uncertainty_m2 = 2e-3;
  EXPECT_GT(watched_search(task, WallRollout(room()), 500), 20U);
}

TEST(ConsistentAnchor, WithAxesOfTheirOwn) {
  Task task = room_task();
  task.goal_axes.free = 0b01;
  EXPECT_GT(watched_search(task, WallRollout(room()), 500), 10U);
  task.goal_axes.free = 0;
  task.goal_axes.tolerance[1] = 0.05;
  EXPECT_GT(watched_search(task, WallRollout(room()), 500), 20U);
  // What its own tolerance allows is no way to go.
  Particle particle;
  particle.pose = displaced(task.goal, 0.15 * Vector6::Unit(1));
  const double left_m = 0.15 - 0.05 - task.goal_tolerance_m;
  EXPECT_NEAR(anchor_heuristic(summarise({{particle}}, task), task),
              left_m * task.distance_weight_per_m, 1e-9);
}

TEST(ConsistentAnchor, WithAnInsertedPredicate) {
  Task task = room_task();
  task.goal_tolerance_m = 0.06;
  task.inserted = {Vector3(0.02, 0.02, 1.0), task.goal};
  EXPECT_GT(watched_search(task, WallRollout(room()), 500), 40U);
}

TEST(ConsistentAnchor, WithOtherWeights) {
  Task task = room_task();
  task.orientation_weight = 3.0;
  task.distance_weight_per_m = 1.0;
  task.uncertainty_weight_per_m2 = 7e4;
  EXPECT_GT(watched_search(task, WallRollout(room()), 500), 40U);
}

TEST(ConsistentAnchor, WithAPriceOnEveryMove) {
  Task task = room_task();
  task.move_weight = 300.0;
  EXPECT_GT(watched_search(task, WallRollout(room()), 500), 40U);
}

TEST(ConsistentAnchor, OnRealPhysicsOfABoxOnATable) {
  const Task task = load_task(tests::in_tree("planner/tasks/box_on_table_2d.yaml"));
  EXPECT_GE(watched_search(task, sim::OdeRollout(task), 12), 30U);
}

}  // namespace
}  // namespace tenon::planner
