#include "planner/search/belief_graph.h"

#include <cassert>

#include "planner/search/heuristics.h"

namespace tenon::planner {

BeliefGraph::BeliefGraph(const Task& task, const Belief& start, Attractors attractors,
                         SuccessorEngine& succ)
    : task_(task), attractors_(std::move(attractors)), succ_(succ), steps_(step_primitives(task)) {
  number(start);
}

bool BeliefGraph::is_goal(StateId state) const { return at_goal(summaries_[state], task_); }

double BeliefGraph::heuristic(std::size_t v, StateId state) const {
  if (v == 0) return anchor_heuristic(summaries_[state], task_);
  return foliated_heuristic(summaries_[state], attractors_.guides[v - 1], task_);
}

std::vector<Primitive> BeliefGraph::primitives(StateId state) const {
  std::vector<Primitive> all = steps_;
  for (std::size_t i = 0; i < attractors_.goals.size(); ++i) {
    if (const auto to_goal = direct(state, i)) all.push_back(*to_goal);
  }
  return all;
}

std::vector<Edge> BeliefGraph::successors(StateId state) {
  const std::vector<Primitive> actions = primitives(state);
  // A copy: new states may move the table.
  const Belief from = beliefs_[state];
  const auto ends = succ_.successors(from, actions);
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < actions.size(); ++i) {
    if (!ends[i]) continue;
    const StateId to = number(*ends[i]);
    if (to == state) continue;
    edges.push_back({to, edge_cost(summaries_[state], summaries_[to], task_), actions[i].label});
  }
  return edges;
}

Vector6 BeliefGraph::displacement(StateId state, int label) const {
  for (const Primitive& primitive : steps_) {
    if (primitive.label == label) return primitive.displacement;
  }
  const auto to_goal = direct(state, static_cast<std::size_t>(label - kDirectLabel));
  assert(to_goal.has_value());
  return to_goal->displacement;
}

std::optional<Primitive> BeliefGraph::direct(StateId state, std::size_t goal) const {
  return direct_primitive(task_, summaries_[state].mean, attractors_.goals[goal],
                          kDirectLabel + static_cast<int>(goal));
}

StateId BeliefGraph::number(const Belief& belief) {
  const auto [entry, fresh] =
      numbers_.try_emplace(identity(belief), static_cast<StateId>(beliefs_.size()));
  if (fresh) {
    beliefs_.push_back(belief);
    summaries_.push_back(summarise(belief, task_));
  }
  return entry->second;
}

}  // namespace tenon::planner
