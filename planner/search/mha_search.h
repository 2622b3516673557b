#pragma once
// Shared multi-heuristic A* (Aine, Swaminathan, Narayanan, Hwang, Likhachev: Multi-Heuristic A*,
// IJRR 35, 2016). Knows only ids and costs.
//
// One consistent anchor heuristic keeps the bound; any number of others take turns in guiding. All
// share g. A state is expanded at most twice: once for the guides, once for the anchor. The goal is
// a region: a virtual GOAL hangs at cost 0 behind every goal state.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "planner/search/search_graph.h"

namespace tenon::planner {

enum class SearchStatus : std::uint8_t {
  kFound = 0,      ///< a path whose cost is proven within w1 w2
  kExhausted = 1,  ///< the open list ran empty: the searched graph has no path
  kStopped = 2,    ///< the budget ran out; the path, if there is one, is proven as `bound` says
};
[[nodiscard]] const char* to_string(SearchStatus status);

struct SearchParameters {
  double w1 = 2.0;  ///< >= 1, inflates every heuristic
  double w2 = 2.0;  ///< >= 1, how far a guide may lag behind the anchor
  std::size_t expansions_max = 100'000;
};

struct PathEdge {
  StateId from = 0;
  StateId to = 0;
  int label = 0;
};

struct SearchResult {
  SearchStatus status = SearchStatus::kExhausted;
  bool has_path = false;
  std::vector<PathEdge> path;  ///< empty where the start is a goal
  double cost = 0.0;           ///< g(GOAL)
  /// cost <= bound times the optimum: min(w1 w2, w1 cost / L), at least 1. Infinite where nothing
  /// is proven.
  double bound = 0.0;
  double lower_bound = 0.0;         ///< of the optimum: L / w1
  std::vector<StateId> expanded;    ///< in order, twice where it happened twice
  std::vector<std::size_t> queues;  ///< which heuristic chose each of them
  /// As it stood at each of them: what was proven, and the best path's cost, infinite without one.
  std::vector<double> lower_bounds;
  std::vector<double> costs;
  std::size_t generated = 0;  ///< states seen, the start included
};

/// Deterministic: ties are broken by (key, state number).
/// @param stop asked before every expansion; true ends the search
[[nodiscard]] SearchResult mha_search(SearchGraph& graph, const SearchParameters& parameters,
                                      const std::function<bool()>& stop);

}  // namespace tenon::planner
