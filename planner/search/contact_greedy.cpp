#include "planner/search/contact_greedy.h"

#include <algorithm>
#include <limits>

namespace tenon::planner {
namespace {

/// The same lattice without guides, entered at any state and left at goals of its own.
class Leg : public SearchGraph {
 public:
  Leg(BeliefGraph& graph, StateId start) : graph_(graph), start_(start) {}

  [[nodiscard]] StateId start() const override { return start_; }
  [[nodiscard]] std::vector<Edge> successors(StateId state) override {
    return graph_.successors(state);
  }
  [[nodiscard]] std::size_t inadmissible_count() const override { return 0; }

 protected:
  [[nodiscard]] const BeliefGraph& graph() const { return graph_; }

 private:
  BeliefGraph& graph_;
  StateId start_;
};

class LegToContact final : public Leg {
 public:
  using Leg::Leg;
  [[nodiscard]] bool is_goal(StateId state) const override {
    const auto& particles = graph().belief(state).particles;
    return std::any_of(particles.begin(), particles.end(),
                       [](const Particle& particle) { return particle.signature.count() > 0; });
  }
  /// Nothing is known of where contacts are: the search is Dijkstra's.
  [[nodiscard]] double heuristic(std::size_t /*v*/, StateId /*state*/) const override {
    return 0.0;
  }
};

class LegToGoal final : public Leg {
 public:
  using Leg::Leg;
  [[nodiscard]] bool is_goal(StateId state) const override { return graph().is_goal(state); }
  [[nodiscard]] double heuristic(std::size_t v, StateId state) const override {
    return graph().heuristic(v, state);
  }
};

template <typename T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

SearchResult contact_greedy_search(BeliefGraph& graph, const SearchParameters& parameters,
                                   const std::function<bool()>& stop) {
  LegToContact to_contact(graph, graph.start());
  SearchResult both = mha_search(to_contact, parameters, stop);
  if (!both.has_path) return both;

  const StateId contact = both.path.empty() ? graph.start() : both.path.back().to;
  SearchParameters rest = parameters;
  rest.expansions_max -= std::min(rest.expansions_max, both.expanded.size());
  LegToGoal to_goal(graph, contact);
  const SearchResult second = mha_search(to_goal, rest, stop);
  both.status = second.status;
  both.has_path = second.has_path;
  append(both.path, second.path);
  append(both.expanded, second.expanded);
  append(both.queues, second.queues);
  both.generated += second.generated;
  both.cost += second.cost;
  // Of its legs' optima, which are none of the whole.
  both.lower_bounds.clear();
  both.costs.clear();
  both.bound = std::numeric_limits<double>::infinity();
  both.lower_bound = 0.0;
  return both;
}

}  // namespace tenon::planner
