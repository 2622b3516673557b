// A plan executed by a program of one's own. Its world is made up: a room of 0.90 x 0.70 m around
// the task frame, as task box_on_table_2d has it, with springy walls, and an arm that follows
// exactly.
//
//   tenon-plan planner/tasks/box_on_table_2d.yaml --start 1 -o plan.tnp
//   example_run_a_plan plan.tnp

#include <algorithm>
#include <cstdio>
#include <utility>

#include "executor/plan_executor.h"
#include "shared/base/error.h"
#include "shared/config/load.h"

int main(int argc, char** argv) try {
  using tenon::executor::PlanExecutor;
  if (argc != 2) throw tenon::InputError("usage: example_run_a_plan PLAN.tnp");
  PlanExecutor executor(tenon::load_plan(argv[1]), {.cycle_s = 0.002});
  PlanExecutor::Input input{.tool = executor.plan().start};
  PlanExecutor::Output output;
  auto result = PlanExecutor::Result::kRunning;
  while (result == PlanExecutor::Result::kRunning) {
    result = executor.update(input, output);
    if (const auto* step = output.finished) {
      std::printf("step %zu: %s after %.4f m\n", step->step, to_string(step->result.outcome),
                  step->result.travelled.head<3>().norm());
    }
    input.tool = output.tool;
    for (const auto& [axis, wall_m] : {std::pair(0, 0.45), std::pair(1, 0.35)}) {
      const double at_m = input.tool.position_m[axis];
      input.wrench[axis] = 5e4 * (std::clamp(at_m, -wall_m, wall_m) - at_m);
    }
  }
  return result == PlanExecutor::Result::kDone ? 0 : 1;
} catch (const tenon::InputError& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
