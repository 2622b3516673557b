#pragma once
// What the tables say about one planning run of ours.

#include <cstddef>
#include <string>

#include "planner/planner.h"
#include "shared/task/task.h"

namespace tenon::paper_tables {

struct Figures {
  bool planned = false;
  std::string reason;  ///< where it is not

  double time_s = 0.0;   ///< attractors and search: until there is a path, as the paper's
  double check_s = 0.0;  ///< certification and validation, of which the paper has none
  double cost = 0.0;
  double nodes = 0.0;  ///< of the path, start and goal included
  double expansions_first = 0.0;
  double expansions = 0.0;
  double moves = 0.0;  ///< simulated until there is a path
  double check_moves = 0.0;
  double error_mean_m = 0.0;  ///< of the certified particles' distances from the goal
  double error_std_m = 0.0;

  double bound = 0.0;
  std::size_t variants = 0;  ///< of physics that the written plan holds for
  std::size_t variants_held = 0;
  std::size_t draws = 0;
  std::size_t draws_at_goal = 0;
  std::size_t draws_within = 0;  ///< the particles' reach
  std::size_t draws_within_at_goal = 0;
};

[[nodiscard]] Figures figures_of(const planner::PlanReport& report, const Task& task);

}  // namespace tenon::paper_tables
