#pragma once
// The room of room_task(), planned in an instant by a clock that stands still.

#include "planner/planner.h"
#include "tests/planner/room_task.h"
#include "tests/planner/wall_rollout.h"

namespace tenon::planner {

inline double stopped_clock() { return 0.0; }

inline PlanReport planned(const Task& task, const WallRollout::World& world = room(),
                          const PlannerOptions& options = {}) {
  return make_plan(task, task.starts.front(), WallRollout(world), options, stopped_clock);
}

}  // namespace tenon::planner
