// What a refuted way teaches the graph that is searched.

#include "planner/searched_graph.h"

#include <gtest/gtest.h>

#include "planner/belief/rollout_pool.h"
#include "planner/search_moves.h"
#include "planner/wording.h"
#include "shared/task/pose_error.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

struct Graph {
  explicit Graph(bool carried_axes = false)
      : task(carried(carried_axes)),
        pool(WallRollout(room()), 1),
        succ(pool, search_move(task, task.starts.front(), {}), task.rollout_step_us),
        searched(task, cross_polytope(task, task.starts.front()), {}, succ) {}

  [[nodiscard]] Particle aside(double way_m) const {
    Particle particle = searched.start().particles.front();
    particle.pose.position_m.y() += way_m;
    return particle;
  }

  static Task carried(bool carried_axes) {
    Task task = room_task();
    task.motion.carried_axes = carried_axes;
    return task;
  }

  Task task;
  RolloutPool pool;
  SuccessorEngine succ;
  SearchedGraph searched;
};

TEST(SearchedGraph, GainsSomeOfManyStartsThatMissedEvenlyAmongThem) {
  Graph graph;
  const std::size_t known = graph.searched.start().particles.size();
  Refutation refutation;
  for (int i = 0; i < 40; ++i) refutation.others.push_back(graph.aside(1e-3 * (i + 1)));
  refutation.chain.start = refutation.others.front();
  EXPECT_EQ(graph.searched.add_starts(refutation), 8U);
  const std::vector<Particle>& particles = graph.searched.start().particles;
  ASSERT_EQ(particles.size(), known + 8);
  EXPECT_EQ(particles[known], refutation.others[0]);
  EXPECT_EQ(particles.back(), refutation.others[35]);
  EXPECT_EQ(graph.searched.add_starts(refutation), 0U);
}

TEST(SearchedGraph, GainsAllOfAFew) {
  Graph graph;
  const std::size_t known = graph.searched.start().particles.size();
  Refutation refutation;
  refutation.chain.start = graph.aside(1e-3);
  EXPECT_EQ(graph.searched.add_starts(refutation), 1U);
  refutation.others = {graph.aside(1e-3), graph.aside(2e-3), graph.aside(3e-3)};
  EXPECT_EQ(graph.searched.add_starts(refutation), 2U);
  EXPECT_EQ(graph.searched.start().particles.size(), known + 3);
}

// Those that miss are off to one side: with them alone the mean of all would no longer be the
// middle of where the part may be.
TEST(SearchedGraph, GainsWhatIsAsFarOffTheOtherWayWhereMovesAreAimedAtTheMean) {
  Graph graph(true);
  const Pose middle = mean_pose(graph.searched.start());
  const std::size_t known = graph.searched.start().particles.size();
  Refutation refutation;
  refutation.chain.start = graph.aside(1e-3);
  Vector6 turn = Vector6::Zero();
  turn[4] = 1e-3;
  refutation.chain.start.environment = environment_pose(turn, graph.task.error_about_m);
  EXPECT_EQ(graph.searched.add_starts(refutation), 1U);
  const Belief& start = graph.searched.start();
  ASSERT_EQ(start.particles.size(), known + 2);
  EXPECT_EQ(start.particles[known], refutation.chain.start);
  EXPECT_TRUE(start.particles.back().environment.orientation.isApprox(
      rotation_of({0.0, -1e-3, 0.0}), 1e-12));
  EXPECT_EQ(start.particles.back().physics, refutation.chain.start.physics);
  EXPECT_LT((mean_pose(start).position_m - middle.position_m).norm(), 1e-4);
  EXPECT_EQ(graph.searched.add_starts(refutation), 0U);
}

TEST(SearchedGraph, SaysWhatFollowsForTheNextWay) {
  EXPECT_EQ(way_refuted(3, false), "; 3 starts that missed become particles");
  EXPECT_EQ(way_refuted(1, false), "; it becomes a particle");
  EXPECT_EQ(way_refuted(0, true), "; now followed by the physics that judges");
  EXPECT_EQ(way_refuted(0, false), "; the guide is left");
}

}  // namespace
}  // namespace tenon::planner
