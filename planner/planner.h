#pragma once
// A library user's way in: a task goes in, a certified and validated plan comes out.
//
//   const Task task = load_task("planner/tasks/box_on_table_2d.yaml");
//   const sim::OdeRollout physics(task);
//   const planner::PlanReport report = planner::make_plan(task, task.starts.front(), physics);
//   if (report.plan) write_file("plan.tnp", report.bytes);
//
// Three nouns: a Task says what is to be done, PlannerOptions how (each has a safe default), and
// the PlanReport holds the plan, or the reason why there is none. Any thread may call; nothing is
// kept between two calls, no file is touched, and no clock is read but the one that is handed in.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "planner/cell_fit/cell_assumptions.h"
#include "planner/judge/timed.h"
#include "planner/plan_report.h"
#include "shared/ports/arm_reach.h"
#include "shared/ports/rollout.h"
#include "shared/task/task.h"

namespace tenon::planner {

struct PlannerOptions {
  /// A baseline plans and certifies its single particle alone. Its plan runs at contact speed
  /// throughout, checks no envelope, and is validated as any other but never refused for it.
  PlanMethod method = PlanMethod::kMha;
  /// Of the same task: what is searched on. It may be fast and wrong, since whatever is written is
  /// certified and judged by the true physics alone. Null: that one too.
  const Rollout* search_physics = nullptr;
  std::size_t threads = 1;  ///< >= 1; the plan does not depend on it
  /// What the cell is like that will execute the plan, see fit_to_cell(). Unset: its contact
  /// stiffness is the task's, and its latency at most 10 ms.
  std::optional<CellAssumptions> assumptions;
  /// Of the arm that will execute the plan: what it cannot reach does not exist. Null: no arm is
  /// asked.
  const ArmReach* reach = nullptr;
  std::size_t draws = kDrawsMin;      ///< random starts of each validation
  std::size_t expansions_max = 5000;  ///< of one search
  /// Searches, each without what the last ones had refuted; as many for each tilt that is tried.
  std::size_t rounds_max = 100;
  /// Guarded moves simulated, for guides, search and judging together, after which no path is
  /// searched for any more: a budget that does not depend on the machine or its load. What is being
  /// expanded or judged then is still brought to its end.
  std::uint64_t moves_max = std::numeric_limits<std::uint64_t>::max();
  /// How long to look for better plans once there is one, with ever lower weights on the same graph
  /// (s, by the clock that is handed in). 0: the first plan is the plan.
  double improve_s = 0.0;
  /// Told of every plan that is kept, the first and each better one, with its bytes; may be empty.
  std::function<void(const PlanReport&)> planned;
  /// Told, in a line, what has just been done, and every second or so that planning goes on; may be
  /// empty. Called from the caller's thread.
  std::function<void(const std::string&)> progress;
};

/// Plans from one of the task's starts. Takes seconds to minutes, and as many threads as the
/// options say. Results depend on task, start and options, not on the number of threads; where the
/// time limit strikes depends on the clock.
/// @param rollout true physics of the same task; cloned for each thread
/// @param now_s for the task's time limit (time_limit_s) and the times of the report. Without one
/// there is no limit but expansions_max, rounds_max and moves_max, and all times are 0
/// @return the status says whether there is a plan; no plan is no error
/// @throws InputError where a plan cannot be represented in a file
[[nodiscard]] PlanReport make_plan(const Task& task, const Start& start, const Rollout& rollout,
                                   const PlannerOptions& options = {},
                                   const ClockSeconds& now_s = {});

}  // namespace tenon::planner
