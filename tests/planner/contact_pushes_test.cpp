// Faces that the start's spread misses are found with what is left of it when other contacts have
// been made, and only after those.

#include "planner/search/contact_pushes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "planner/belief/belief.h"
#include "planner/belief/rollout_pool.h"
#include "planner/search/attractors.h"
#include "planner/search_moves.h"
#include "shared/task/own_moves.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

// Two walls along y, and along x nothing but a ledge that is 20 mm wide.
constexpr double kLedge_m = -0.5;

WallRollout::World ledge_world() {
  WallRollout::World world;
  world.low_m = {-5.0, -0.4, -1.0};
  world.high_m = {5.0, 0.4, 1.0};
  world.ledge_m = kLedge_m - world.low_m.x();
  world.ledge_from_y_m = -0.01;
  world.ledge_to_y_m = 0.01;
  return world;
}

Task ledge_task() {
  Task task = room_task();
  task.starts.front().pose.position_m = {-0.1, 0.0, 0.0};
  task.environment = {
      {"ledge", Shape::Kind::kBox, {0.1, 0.02, 0.1}, {{kLedge_m - 0.05, 0, 0}, {1, 0, 0, 0}}},
      {"wall", Shape::Kind::kBox, {0.4, 0.1, 0.1}, {{0, 0.45, 0}, {1, 0, 0, 0}}}};
  task.held = {{"point", Shape::Kind::kBox, {1e-3, 1e-3, 1e-3}, {}}};
  task.motion.timeout_us = 60'000'000;
  derive_moves(task);
  return task;
}

TEST(ContactPushes, ANarrowFaceIsMetOnceWhatLiesAcrossItIsSettled) {
  const Task task = ledge_task();
  const Start& where = task.starts.front();
  ASSERT_GT(task.particle_sigmas * where.sigma[1], 0.01);
  RolloutPool pool(WallRollout(ledge_world()), 1);
  const Belief start = cross_polytope(task, where);
  SuccessorEngine succ(pool, search_move(task, where, {}), task.rollout_step_us);
  const std::vector<Guide> guides = find_attractors(task, start, succ, pool.front()).candidates;
  ASSERT_FALSE(guides.empty());
  EXPECT_EQ(std::count_if(guides.begin(), guides.end(),
                          [](const Guide& guide) { return guide.contacts.front().axis == 0; }),
            0);
  const ContactAttractor& last = guides.front().contacts.back();
  EXPECT_EQ(last.axis, 0);
  EXPECT_NEAR(last.mean.position_m.x(), kLedge_m, 1e-9);
  EXPECT_LT(last.spread, 1e-9);
  EXPECT_TRUE(has(last.after, 1));
  EXPECT_FALSE(has(last.after, 0));
}

}  // namespace
}  // namespace tenon::planner
