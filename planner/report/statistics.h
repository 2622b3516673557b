#pragma once
// How a plan was found: as a file for programs, and read back from it. Pure; any thread.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "planner/plan_report.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// Keys are documented in planner/README.md.
[[nodiscard]] std::string statistics_json(const PlanReport& report, const Task& task);

/// What such a file says of the search.
struct SearchStory {
  /// A part of planning.
  struct Phase {
    std::string name;  ///< "attractors", "search", "certification", "corners", "validation"
    double time_s = 0.0;
    std::uint64_t moves = 0;  ///< simulated
  };
  std::vector<std::string> heuristics;  ///< see PlanReport
  std::string guide;                    ///< likewise
  std::vector<SearchRound> rounds;
  double bound = 0.0;  ///< of the plan's cost; 0: none
  /// The course of the search that found the plan, some expansions of it at most, the last among
  /// them; empty where none did. Costs are infinite before there is a path.
  std::vector<std::size_t> expansions;
  std::vector<double> lower_bounds;
  std::vector<double> costs;
  std::vector<Phase> phases;
  std::size_t states = 0;
};

/// @param file its name, for refusals  @param text its contents  @param plan bytes of the plan that
/// it must be of  @throws InputError naming what is missing, wrong, or of another plan
[[nodiscard]] SearchStory read_statistics(const std::string& file, const std::string& text,
                                          std::span<const std::uint8_t> plan);

}  // namespace tenon::planner
