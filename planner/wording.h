#pragma once
// The words in which the planner says what it has found, what it has learnt, and why there is no
// plan. Pure; any thread.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "planner/judge/judged_starts.h"
#include "planner/judge/refutation.h"
#include "planner/plan_report.h"
#include "planner/search/belief_graph.h"
#include "planner/search/guide.h"
#include "planner/search/mha_search.h"

namespace tenon::planner {

/// What ends a search that finds no path.
struct SearchLimits {
  double time_s = 0.0;
  std::size_t expansions = 0;
  std::uint64_t moves = 0;
};

/// "+x to a face, -z to a face".
[[nodiscard]] std::string guide_text(const Guide& guide);

/// What chooses among the open states: the anchor, then each guide.
[[nodiscard]] std::vector<std::string> heuristic_names(const std::vector<Guide>& guides);

// Progress.
/// That planning goes on. @param doing "searching"  @param moves simulated so far, of all kinds
[[nodiscard]] std::string still(const char* doing, std::uint64_t moves, std::size_t states);
[[nodiscard]] std::string guide_left(const Guide& guide, const std::string& where);
[[nodiscard]] std::string guides_found(const std::vector<Guide>& guides, std::uint64_t moves);
/// That a guide leads to the goal by itself. @param moves of that way
[[nodiscard]] std::string guide_followed(const Guide& guide, std::size_t moves);
[[nodiscard]] std::string path_found(const SearchResult& search);

/// No plan was found for more of the task's calibration errors. @param held of them from now on
[[nodiscard]] std::string less_to_hold(const CalibrationErrors& held);

/// What follows for the next way that a guide leads from what refuted the last one.
/// @param starts that have become particles  @param truer whether the guide is followed by what
/// judges then
[[nodiscard]] std::string way_refuted(std::size_t starts, bool truer);

/// What refuted a path, and what was learnt from it.
/// @param refused_step whose move the search does without; empty where the start became a particle
[[nodiscard]] std::string lesson(const Refutation& refutation,
                                 std::optional<std::size_t> refused_step);

// Reasons: why there is no plan.
[[nodiscard]] std::string already_at_goal(const Start& start);
/// @param status kTimeLimit, kMoveLimit, kExpansionLimit, kNoAttractor or kExhausted
/// @param report of all searches so far  @param graph how near the last one came
/// @param errors of the task's starts
[[nodiscard]] std::string no_path(PlanStatus status, const PlanReport& report,
                                  const BeliefGraph& graph, const SearchLimits& limits,
                                  Distribution errors);
[[nodiscard]] std::string every_path_refuted(const PlanReport& report, std::size_t paths);

}  // namespace tenon::planner
