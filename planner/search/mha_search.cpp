#include "planner/search/mha_search.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

namespace tenon::planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr StateId kGoal = std::numeric_limits<StateId>::max();

class Search {
 public:
  Search(SearchGraph& graph, const SearchParameters& parameters)
      : graph_(graph), parameters_(parameters), open_(graph.inadmissible_count() + 1) {
    assert(parameters.w1 >= 1.0 && parameters.w2 >= 1.0);
    node(kGoal);
    node(graph.start()).g = 0.0;
    for (std::size_t v = 0; v < open_.size(); ++v) put(graph.start(), v);
  }

  SearchResult run(const std::function<bool()>& stop) {
    const std::size_t guides = open_.size() - 1;
    for (std::size_t turn = 0; !open_[0].empty(); ++turn) {
      const std::size_t v = guides == 0 ? 0 : 1 + turn % guides;
      const std::size_t q = v > 0 && min_key(v) <= parameters_.w2 * min_key(0) ? v : 0;
      lower_bound_ = std::max(lower_bound_, min_key(0));
      if (g(kGoal) < kInfinity && g(kGoal) <= min_key(q)) return result(SearchStatus::kFound);
      if (stop() || result_.expanded.size() >= parameters_.expansions_max) {
        return result(SearchStatus::kStopped);
      }
      expand(open_[q].begin()->second, q);
    }
    return result(SearchStatus::kExhausted);
  }

 private:
  struct Node {
    double g = kInfinity;
    bool closed_by_anchor = false;
    bool closed_by_guide = false;
    std::optional<PathEdge> parent;
    std::vector<double> heuristic;  // by v, once known
    std::vector<double> open_key;   // by v, infinite where it is not open
  };

  Node& node(StateId state) {
    const auto [entry, fresh] = nodes_.try_emplace(state);
    if (fresh) {
      entry->second.heuristic.assign(open_.size(), -1.0);
      entry->second.open_key.assign(open_.size(), kInfinity);
    }
    return entry->second;
  }

  double g(StateId state) { return node(state).g; }

  double min_key(std::size_t v) const {
    return open_[v].empty() ? kInfinity : open_[v].begin()->first;
  }

  double key(StateId state, std::size_t v) {
    if (state == kGoal) return g(kGoal);
    Node& n = node(state);
    if (n.heuristic[v] < 0.0) n.heuristic[v] = graph_.heuristic(v, state);
    return n.g + parameters_.w1 * n.heuristic[v];
  }

  void put(StateId state, std::size_t v) {
    take(state, v);
    double& open_key = node(state).open_key[v];
    open_key = key(state, v);
    open_[v].emplace(open_key, state);
  }

  void take(StateId state, std::size_t v) {
    double& open_key = node(state).open_key[v];
    if (open_key == kInfinity) return;
    open_[v].erase({open_key, state});
    open_key = kInfinity;
  }

  void expand(StateId state, std::size_t q) {
    assert(state != kGoal);
    (q == 0 ? node(state).closed_by_anchor : node(state).closed_by_guide) = true;
    for (std::size_t v = 0; v < open_.size(); ++v) take(state, v);
    result_.expanded.push_back(state);
    result_.queues.push_back(q);
    result_.lower_bounds.push_back(lower_bound_ / parameters_.w1);
    result_.costs.push_back(g(kGoal));
    if (graph_.is_goal(state)) return relax({state, kGoal, 0}, 0.0);
    for (const Edge& edge : graph_.successors(state)) {
      if (edge.to != state) relax({state, edge.to, edge.label}, edge.cost);
    }
  }

  void relax(const PathEdge& edge, double cost) {
    const double through = g(edge.from) + cost;
    Node& to = node(edge.to);
    if (!(through < to.g)) return;
    to.g = through;
    to.parent = edge;
    if (to.closed_by_anchor) return;
    put(edge.to, 0);
    if (to.closed_by_guide) return;
    for (std::size_t v = 1; v < open_.size(); ++v) {
      if (key(edge.to, v) <= parameters_.w2 * key(edge.to, 0)) {
        put(edge.to, v);
      } else {
        take(edge.to, v);  // its old key is no longer right
      }
    }
  }

  SearchResult result(SearchStatus status) {
    result_.status = status;
    result_.has_path = g(kGoal) < kInfinity;
    result_.generated = nodes_.size() - 1;
    result_.lower_bound = lower_bound_ / parameters_.w1;
    result_.cost = g(kGoal);
    result_.bound = kInfinity;
    if (!result_.has_path) return std::move(result_);

    const double proven = result_.cost > 0.0 ? result_.cost / result_.lower_bound : 1.0;
    const double promised =
        status == SearchStatus::kFound ? parameters_.w1 * parameters_.w2 : kInfinity;
    result_.bound = std::max(1.0, std::min(promised, proven));
    for (auto edge = node(kGoal).parent; edge && edge->from != graph_.start();) {
      edge = node(edge->from).parent;
      result_.path.push_back(*edge);
    }
    std::reverse(result_.path.begin(), result_.path.end());
    return std::move(result_);
  }

  SearchGraph& graph_;
  SearchParameters parameters_;
  std::vector<std::set<std::pair<double, StateId>>> open_;  // [0] the anchor's
  std::unordered_map<StateId, Node> nodes_;
  double lower_bound_ = 0.0;  // L: largest minimum of the anchor's keys so far
  SearchResult result_;
};

}  // namespace

const char* to_string(SearchStatus status) {
  switch (status) {
    case SearchStatus::kFound:
      return "found";
    case SearchStatus::kExhausted:
      return "open list exhausted";
    case SearchStatus::kStopped:
      return "budget spent";
  }
  return "?";
}

SearchResult mha_search(SearchGraph& graph, const SearchParameters& parameters,
                        const std::function<bool()>& stop) {
  return Search(graph, parameters).run(stop);
}

}  // namespace tenon::planner
