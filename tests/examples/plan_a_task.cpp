// Planning from a program of one's own: a task goes in, the bytes of a plan file come out.
//   plan_a_task [TASK.yaml [PLAN.tnp]]

#include <cstdio>

#include "planner/planner.h"
#include "shared/base/error.h"
#include "shared/config/load.h"
#include "sim/physics/rollout/ode_rollout.h"

int main(int argc, char** argv) {
  using namespace tenon;
  try {
    // The problem: shapes, the goal, and starts with what is uncertain about them. A file that is
    // wrong is refused with its line and its key.
    const Task task = load_task(argc > 1 ? argv[1] : "planner/tasks/box_on_table_2d.yaml");
    const Start& start = task.starts.front();  // "1"
    const sim::OdeRollout physics(task);

    // Every option has a safe default. There is no clock among the arguments here: then the budget
    // alone ends a search, and not the task's time limit.
    planner::PlannerOptions options;
    options.threads = 2;
    const planner::PlanReport report = planner::make_plan(task, start, physics, options);
    if (!report.plan) {
      std::fprintf(stderr, "%s: %s\n", to_string(report.status), report.reason.c_str());
      return 1;
    }
    // What a file would hold, and what it says.
    std::printf("start %s: %zu steps in %zu bytes, %u of %u random starts end at the goal\n",
                start.name.c_str(), report.plan->steps.size(), report.bytes.size(),
                report.plan->draws_at_goal, report.plan->draws);
    if (argc > 2) write_file(argv[2], report.bytes);
    return 0;
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
