#include "tests/benchmarks/paper_tables/toy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "planner/judge/plan_draft.h"
#include "planner/search/attractors.h"
#include "planner/search/belief_graph.h"
#include "planner/search/mha_search.h"
#include "planner/search_moves.h"
#include "shared/base/text.h"

namespace tenon::paper_tables {
namespace {

struct PaperExpansion {
  const char* turn;
  const char* led;
  const char* selector;
  const char* parent;
  const char* children;
};

/// Its alpha leads to the left wall, its beta to the right one.
constexpr std::array<PaperExpansion, 6> kTable1 = {{{"left", "no", "h0", "S", "S1 S1'"},
                                                    {"right", "yes", "h_right", "S1'", "S2'"},
                                                    {"left", "yes", "h_left", "S1", "S3"},
                                                    {"right", "yes", "h_right", "S2'", "S4'"},
                                                    {"left", "yes", "h_g", "S4'", "S5"},
                                                    {"right", "yes", "h_g", "S5", "S6 = G"}}};

std::string side(const planner::Guide& guide) {
  return guide.contacts.front().mean.position_m.x() < 0.0 ? "left" : "right";
}

/// "S2 x +100 u 30": the number, and mean and root of the uncertainty in mm.
std::string name_of(const planner::BeliefGraph& graph, planner::StateId state) {
  const planner::BeliefSummary& belief = graph.summary(state);
  return format("S%u x %+.0f u %.0f", state, 1e3 * belief.mean.position_m.x(),
                1e3 * std::sqrt(belief.uncertainty_m2));
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::vector<Expansion> expansions_of(const Task& toy, const Rollout& rollout) {
  const planner::CellAssumptions cell{.contact_stiffness_Npm = toy.contact_stiffness_Npm};
  const MoveParameters move = planner::search_move(toy, toy.starts.front(), cell);
  planner::RolloutPool pool(rollout, 1);
  planner::SuccessorEngine succ(pool, move, toy.rollout_step_us);
  planner::SuccessorEngine long_succ(pool, planner::long_move(toy, move), toy.rollout_step_us);

  const planner::Belief start = planner::cross_polytope(toy, toy.starts.front());
  const planner::Attractors attractors =
      planner::find_attractors(toy, start, long_succ, pool.front());
  planner::BeliefGraph graph(toy, start, attractors, succ);
  const planner::SearchResult search =
      planner::mha_search(graph, {toy.w1, toy.w2, 1000}, [] { return false; });

  std::vector<Expansion> expansions;
  std::set<planner::StateId> seen = {graph.start()};
  for (std::size_t i = 0; i < search.expanded.size(); ++i) {
    const planner::StateId parent = search.expanded[i];
    const std::size_t queue = search.queues[i];
    const bool certain = graph.summary(parent).uncertainty_m2 <= toy.goal_uncertainty_m2;
    Expansion expansion;
    expansion.turn = side(attractors.guides[i % attractors.guides.size()]);
    expansion.led = queue != 0;
    expansion.selector = queue == 0 ? "h0" : "h_" + (certain ? "g" : expansion.turn);
    expansion.parent = name_of(graph, parent) + (graph.is_goal(parent) ? " = G" : "");
    if (!graph.is_goal(parent)) {
      for (const planner::Edge& edge : graph.successors(parent)) {
        if (seen.insert(edge.to).second) expansion.children.push_back(name_of(graph, edge.to));
      }
    }
    expansions.push_back(std::move(expansion));
  }
  return expansions;
}

std::string text_of(const std::vector<Expansion>& ours) {
  std::string text =
      "\nTable I: the one-dimensional example. toy_1d.yaml: states as number, mean and root of u "
      "in "
      "mm.\n     | paper                                  | ours\n     | turn  led selector parent "
      "children      | turn  led selector parent            new children\n";
  for (std::size_t i = 0; i < std::max(ours.size(), kTable1.size()); ++i) {
    const PaperExpansion paper =
        i < kTable1.size() ? kTable1[i] : PaperExpansion{"", "", "", "", ""};
    text += format("%4zu | %-5s %-3s %-8s %-6s %-13s |", i + 1, paper.turn, paper.led,
                   paper.selector, paper.parent, paper.children);
    if (i < ours.size()) {
      text += format(" %-5s %-3s %-8s %-17s %s", ours[i].turn.c_str(), ours[i].led ? "yes" : "no",
                     ours[i].selector.c_str(), ours[i].parent.c_str(),
                     joined(ours[i].children).c_str());
    }
    text += "\n";
  }
  return text;
}

nlohmann::ordered_json json_of(const std::vector<Expansion>& ours) {
  nlohmann::ordered_json json = {{"table", "I"}, {"task", "toy_1d.yaml"}};
  for (const Expansion& expansion : ours) {
    json["rows"].push_back({{"turn", expansion.turn},
                            {"led", expansion.led},
                            {"selector", expansion.selector},
                            {"parent", expansion.parent},
                            {"children", expansion.children}});
  }
  return json;
}

}  // namespace tenon::paper_tables
