#pragma once
// Tasks for WallRollout: a point that is to find its place in a room of 1.0 x 0.8 m.

#include "shared/task/own_moves.h"
#include "shared/task/task.h"
#include "tests/planner/wall_rollout.h"

namespace tenon::planner {

inline WallRollout::World room() {
  WallRollout::World world;
  world.low_m = {-0.5, -0.4, -1.0};
  world.high_m = {0.5, 0.4, 1.0};
  return world;
}

inline Task room_task() {
  Task task;
  task.name = "room";
  task.w1 = 2.0;
  task.w2 = 2.0;
  task.coordinates = 0b11;
  task.compliance.compliant_axes = 0b11;
  Start start;
  start.name = "a";
  start.pose.position_m = {-0.23, -0.11, 0.0};
  start.sigma.head<2>() << 0.03, 0.03;
  task.starts = {start};
  task.goal.position_m = {0.17, 0.12, 0.0};
  return task;
}

/// The room as a task that brings no primitives: its moves follow from its sizes.
inline Task own_room_task() {
  Task task = room_task();
  task.environment = {{"floor", Shape::Kind::kBox, {1.0, 0.8, 0.1}, {}}};
  task.held = {{"point", Shape::Kind::kBox, {0.01, 0.01, 0.01}, {}}};
  task.motion.timeout_us = 60'000'000;
  derive_moves(task);
  return task;
}

}  // namespace tenon::planner
