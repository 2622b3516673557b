#pragma once
// What a search sees of a problem: numbered states, edges with costs, heuristics, goals. No
// physics.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tenon::planner {

using StateId = std::uint32_t;

struct Edge {
  StateId to = 0;
  double cost = 0.0;  ///< >= 0
  int label = 0;      ///< which action; comes back with the path
};

/// Implementations may generate states as they are asked for. Equal calls give equal answers.
class SearchGraph {
 public:
  SearchGraph() = default;
  SearchGraph(const SearchGraph&) = delete;
  SearchGraph& operator=(const SearchGraph&) = delete;
  virtual ~SearchGraph() = default;

  [[nodiscard]] virtual StateId start() const = 0;
  [[nodiscard]] virtual bool is_goal(StateId state) const = 0;
  /// In a fixed order.
  [[nodiscard]] virtual std::vector<Edge> successors(StateId state) = 0;
  /// N: how many heuristics there are beside the anchor.
  [[nodiscard]] virtual std::size_t inadmissible_count() const = 0;
  /// v = 0: the anchor, consistent and 0 at goals. v = 1..N: anything >= 0.
  [[nodiscard]] virtual double heuristic(std::size_t v, StateId state) const = 0;
};

}  // namespace tenon::planner
