#include "planner/search/mha_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

namespace tenon::planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
bool never() { return false; }

/// A graph that is written down: edges, goals, and heuristics by table.
class TableGraph final : public SearchGraph {
 public:
  std::vector<std::vector<Edge>> edges;
  std::vector<bool> goals;
  std::vector<std::vector<double>> heuristics;  // [v][state], [0] the anchor

  [[nodiscard]] StateId start() const override { return 0; }
  [[nodiscard]] bool is_goal(StateId state) const override { return goals[state]; }
  [[nodiscard]] std::vector<Edge> successors(StateId state) override { return edges[state]; }
  [[nodiscard]] std::size_t inadmissible_count() const override { return heuristics.size() - 1; }
  [[nodiscard]] double heuristic(std::size_t v, StateId state) const override {
    return heuristics[v][state];
  }
};

/// Costs to the nearest goal: Dijkstra backwards from the goals, by plain scans.
std::vector<double> costs_to_goal(const TableGraph& graph) {
  std::vector<double> cost(graph.edges.size(), kInfinity);
  for (std::size_t s = 0; s < cost.size(); ++s) {
    if (graph.goals[s]) cost[s] = 0.0;
  }
  std::vector<bool> settled(cost.size(), false);
  for (;;) {
    std::size_t nearest = cost.size();
    for (std::size_t s = 0; s < cost.size(); ++s) {
      if (settled[s] || !std::isfinite(cost[s])) continue;
      if (nearest == cost.size() || cost[s] < cost[nearest]) nearest = s;
    }
    if (nearest == cost.size()) return cost;
    settled[nearest] = true;
    for (std::size_t s = 0; s < cost.size(); ++s) {
      for (const Edge& edge : graph.edges[s]) {
        if (edge.to == nearest) cost[s] = std::min(cost[s], edge.cost + cost[nearest]);
      }
    }
  }
}

/// Weighted A* without reopening, by plain scans: the order of its expansions, and the cost.
struct WeightedAStar {
  std::vector<StateId> expanded;
  double cost = kInfinity;
};
WeightedAStar weighted_a_star(const TableGraph& graph, double weight) {
  WeightedAStar result;
  std::vector<double> g(graph.edges.size(), kInfinity);
  std::vector<bool> open(g.size(), false);
  std::vector<bool> closed(g.size(), false);
  g[0] = 0.0;
  open[0] = true;
  const auto key = [&](std::size_t s) { return g[s] + weight * graph.heuristics[0][s]; };
  for (;;) {
    std::size_t top = g.size();
    for (std::size_t s = 0; s < g.size(); ++s) {
      if (open[s] && (top == g.size() || key(s) < key(top))) top = s;
    }
    if (top == g.size() || result.cost <= key(top)) return result;
    open[top] = false;
    closed[top] = true;
    result.expanded.push_back(static_cast<StateId>(top));
    if (graph.goals[top]) {
      result.cost = std::min(result.cost, g[top]);
      continue;
    }
    for (const Edge& edge : graph.edges[top]) {
      if (closed[edge.to] || g[top] + edge.cost >= g[edge.to]) continue;
      g[edge.to] = g[top] + edge.cost;
      open[edge.to] = true;
    }
  }
}

/// Lowers the anchor until h(s) <= c(s, s') + h(s') on every edge.
void make_consistent(TableGraph& graph) {
  std::vector<double>& h = graph.heuristics[0];
  for (std::size_t round = 0; round < h.size(); ++round) {
    for (std::size_t s = 0; s < h.size(); ++s) {
      for (const Edge& edge : graph.edges[s]) h[s] = std::min(h[s], edge.cost + h[edge.to]);
    }
  }
}

void fill_randomly(TableGraph& graph, unsigned seed, std::size_t guides) {
  std::mt19937 random(seed);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  const std::size_t states = 5 + below(60);
  graph.edges.resize(states);
  graph.goals.resize(states);
  for (std::size_t s = 0; s < states; ++s) {
    for (std::size_t e = below(5); e > 0; --e) {
      // Whole costs, zero among them, so that ties are common.
      graph.edges[s].push_back({static_cast<StateId>(below(states)), static_cast<double>(below(10)),
                                static_cast<int>(e)});
    }
    graph.goals[s] = s > 0 && below(15) == 0;
  }
  const std::vector<double> exact = costs_to_goal(graph);
  graph.heuristics.resize(guides + 1);
  for (std::size_t s = 0; s < states; ++s) {
    const double most = std::isfinite(exact[s]) ? exact[s] : 100.0;
    graph.heuristics[0].push_back(graph.goals[s] ? 0.0
                                                 : most * static_cast<double>(below(11)) / 10);
    for (std::size_t v = 1; v <= guides; ++v) {
      graph.heuristics[v].push_back(static_cast<double>(below(30)));
    }
  }
  make_consistent(graph);
}

double cost_of(const TableGraph& graph, const SearchResult& result) {
  StateId at = graph.start();
  double cost = 0.0;
  for (const PathEdge& step : result.path) {
    EXPECT_EQ(step.from, at);
    double cheapest = kInfinity;
    for (const Edge& edge : graph.edges[at]) {
      if (edge.to == step.to) cheapest = std::min(cheapest, edge.cost);
    }
    cost += cheapest;
    at = step.to;
  }
  EXPECT_TRUE(graph.goals[at]);
  return cost;
}

/// As the search went its cost fell and what was proven rose, and both were true all the time.
void expect_course(const SearchResult& result, double exact) {
  ASSERT_EQ(result.costs.size(), result.expanded.size());
  ASSERT_EQ(result.lower_bounds.size(), result.expanded.size());
  double cost = kInfinity;
  double proven = 0.0;
  for (std::size_t i = 0; i < result.costs.size(); ++i) {
    EXPECT_LE(result.costs[i], cost);
    EXPECT_GE(result.costs[i], exact - 1e-9);
    EXPECT_GE(result.lower_bounds[i], proven);
    EXPECT_LE(result.lower_bounds[i], exact + 1e-9);
    cost = result.costs[i];
    proven = result.lower_bounds[i];
  }
  EXPECT_LE(result.cost, cost);
  EXPECT_GE(result.lower_bound, proven);
}

TEST(MhaSearch, KeepsItsBoundOnRandomGraphsAndExpandsNoStateThrice) {
  std::size_t with_path = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    TableGraph graph;
    fill_randomly(graph, seed, seed % 4);
    const double exact = costs_to_goal(graph)[0];
    const SearchParameters parameters{1.0 + 0.5 * (seed % 5), 1.0 + 4.0 * (seed % 3), 100000};
    const SearchResult result = mha_search(graph, parameters, never);
    ASSERT_EQ(result.has_path, std::isfinite(exact)) << "seed " << seed;
    std::map<StateId, int> expansions;
    for (const StateId state : result.expanded) ASSERT_LE(++expansions[state], 2);
    expect_course(result, exact);
    if (!result.has_path) {
      EXPECT_EQ(result.status, SearchStatus::kExhausted);
      continue;
    }
    ++with_path;
    const double cost = cost_of(graph, result);
    EXPECT_LE(cost, result.cost + 1e-9);
    EXPECT_LE(result.cost, parameters.w1 * parameters.w2 * exact + 1e-9) << "seed " << seed;
    // The certificate itself must be true, and never weaker than what was promised.
    EXPECT_LE(result.cost, result.bound * exact + 1e-9) << "seed " << seed;
    EXPECT_LE(result.bound, parameters.w1 * parameters.w2 + 1e-12);
    EXPECT_LE(result.lower_bound, exact + 1e-9) << "seed " << seed;
  }
  EXPECT_GE(with_path, 250U);
}

TEST(MhaSearch, IsOptimalWithUnitWeights) {
  for (unsigned seed = 1000; seed < 1300; ++seed) {
    TableGraph graph;
    fill_randomly(graph, seed, seed % 4);
    const double exact = costs_to_goal(graph)[0];
    const SearchResult result = mha_search(graph, {1.0, 1.0, 100000}, never);
    ASSERT_EQ(result.has_path, std::isfinite(exact));
    if (result.has_path) {
      EXPECT_NEAR(result.cost, exact, 1e-9) << "seed " << seed;
    }
  }
}

TEST(MhaSearch, WithoutGuidesItIsWeightedAStarExpansionForExpansion) {
  for (unsigned seed = 3000; seed < 4000; ++seed) {
    TableGraph graph;
    fill_randomly(graph, seed, 0);
    const double weight = 1.0 + 0.5 * (seed % 5);
    const WeightedAStar slow = weighted_a_star(graph, weight);
    const SearchResult result = mha_search(graph, {weight, 1.0 + seed % 3, 100000}, never);
    EXPECT_EQ(result.expanded, slow.expanded) << "seed " << seed;
    ASSERT_EQ(result.has_path, std::isfinite(slow.cost));
    if (result.has_path) {
      EXPECT_EQ(result.cost, slow.cost) << "seed " << seed;
    }
  }
}

TEST(MhaSearch, AStoppedSearchClaimsOnlyWhatItCanProve) {
  for (unsigned seed = 2000; seed < 3000; ++seed) {
    TableGraph graph;
    fill_randomly(graph, seed, 2);
    const double exact = costs_to_goal(graph)[0];
    for (std::size_t limit = 0; limit < 12; ++limit) {
      const SearchResult result = mha_search(graph, {3.0, 3.0, limit}, never);
      EXPECT_LE(result.expanded.size(), limit);
      if (result.has_path) {
        EXPECT_LE(result.cost, result.bound * exact + 1e-9);
      }
    }
  }
}

TEST(MhaSearch, TiesGoToTheLowerStateNumber) {
  TableGraph graph;
  graph.edges = {
      {{3, 1.0, 0}, {2, 1.0, 1}, {1, 1.0, 2}}, {{4, 1.0, 0}}, {{4, 1.0, 0}}, {{4, 1.0, 0}}, {}};
  graph.goals = {false, false, false, false, true};
  graph.heuristics = {std::vector<double>(5, 0.0)};
  const SearchResult result = mha_search(graph, {1.0, 1.0, 100}, never);
  ASSERT_EQ(result.path.size(), 2U);
  EXPECT_EQ(result.path[0].to, 1U);
  EXPECT_EQ(result.path[0].label, 2);
  EXPECT_EQ(result.expanded, (std::vector<StateId>{0, 1, 2, 3, 4}));
}

TEST(MhaSearch, StopIsAskedBeforeEveryExpansion) {
  TableGraph graph;
  fill_randomly(graph, 7, 1);
  const SearchResult result = mha_search(graph, {1.0, 1.0, 100}, [] { return true; });
  EXPECT_EQ(result.status, SearchStatus::kStopped);
  EXPECT_TRUE(result.expanded.empty());
  EXPECT_FALSE(result.has_path);
}

// The paper's one-dimensional example: uncertain states drift towards a wall on either side,
// h_alpha leads left and h_beta right; pressing against the right wall makes the state certain.
//
//   left  S3 <- S1 <- S -> S1' -> S2' -> S4' (certain) -> S5 -> G
TEST(MhaSearch, ExpandsThePapersToyExampleInTheOrderOfItsTable) {
  enum : StateId { kS, kS1, kS1p, kS3, kS2p, kS4, kS4p, kS5, kG };
  TableGraph graph;
  graph.edges = {{{kS1, 101.0, 0}, {kS1p, 101.0, 1}},  // uncertain: w_u u = 100 an edge
                 {{kS3, 101.0, 0}},
                 {{kS2p, 101.0, 1}},
                 {},
                 {{kS4, 101.0, 0}, {kS4p, 101.0, 1}},
                 {},
                 {{kS5, 1.0, 0}},  // certain: distance alone
                 {{kG, 1.0, 0}},
                 {}};
  graph.goals = std::vector<bool>(9, false);
  graph.goals[kG] = true;
  const auto h = [](double a, double b, double c, double d, double e, double f, double g,
                    double i) { return std::vector<double>{a, b, c, d, e, f, g, i, 0.0}; };
  //                      S      S1     S1'    S3     S2'    S4   S4'  S5
  graph.heuristics = {h(101.0, 102.0, 100.0, 103.0, 101.0, 100.0, 2.0, 1.0),
                      h(210.0, 103.0, 305.0, 302.0, 306.0, 304.0, 2.0, 1.0),   // alpha
                      h(203.0, 304.0, 102.0, 305.0, 101.0, 303.0, 2.0, 1.0)};  // beta
  const SearchResult result = mha_search(graph, {1.0, 2.0, 100}, never);
  ASSERT_TRUE(result.has_path);
  const std::vector<StateId> first(result.expanded.begin(), result.expanded.begin() + 6);
  EXPECT_EQ(first, (std::vector<StateId>{kS, kS1p, kS1, kS2p, kS4p, kS5}));
  // "Satisfied line 37?": no at first, when the anchor chooses, and yes ever after.
  const std::vector<std::size_t> queues(result.queues.begin(), result.queues.begin() + 6);
  EXPECT_EQ(queues, (std::vector<std::size_t>{0, 2, 1, 2, 1, 2}));
  EXPECT_DOUBLE_EQ(result.cost, 305.0);
}

}  // namespace
}  // namespace tenon::planner
