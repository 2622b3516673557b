#include "planner/search/belief_graph.h"

#include <algorithm>
#include <cassert>

#include "planner/search/guide_moves.h"
#include "planner/search/heuristics.h"

namespace tenon::planner {
namespace {

// A part that slides off an edge does so a little elsewhere each time, and may catch on it: it
// costs as much as so many further moves.
constexpr double kSlideOffMoves = 2.0;

/// Whether any particle has lost a contact along an axis that the move does not go along.
bool slides_off(const Belief& before, const Belief& after, const Vector6& displacement) {
  for (std::size_t i = 0; i < before.particles.size(); ++i) {
    const ContactSignature held = before.particles[i].signature;
    for (int axis = 0; axis < 6; ++axis) {
      const bool lost =
          held.sign(axis) != 0 && after.particles[i].signature.sign(axis) != held.sign(axis);
      if (lost && displacement[axis] == 0.0) return true;
    }
  }
  return false;
}

}  // namespace

BeliefGraph::BeliefGraph(const Task& task, const Belief& start, Attractors attractors,
                         SuccessorEngine& succ)
    : task_(task),
      grid_(grid_of(task)),
      attractors_(std::move(attractors)),
      succ_(succ),
      steps_(step_primitives(task)) {
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
  if (task_.guide_moves) {
    const auto suggested = guide_moves(task_, summaries_[state], attractors_.guides);
    all.insert(all.end(), suggested.begin(), suggested.end());
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
    double cost = edge_cost(summaries_[state], summaries_[to], task_);
    if (task_.guide_moves && slides_off(from, *ends[i], actions[i].displacement)) {
      cost += kSlideOffMoves * move_cost(task_, summaries_[state].uncertainty_m2);
    }
    edges.push_back({to, cost, actions[i].label});
  }
  return edges;
}

Vector6 BeliefGraph::displacement(StateId state, int label) const {
  const std::vector<Primitive> all = primitives(state);
  const auto chosen = std::find_if(all.begin(), all.end(), [label](const Primitive& primitive) {
    return primitive.label == label;
  });
  assert(chosen != all.end());
  return chosen->displacement;
}

std::optional<Primitive> BeliefGraph::direct(StateId state, std::size_t goal) const {
  return direct_primitive(task_, summaries_[state].mean, attractors_.goals[goal],
                          kDirectLabel + static_cast<int>(goal));
}

StateId BeliefGraph::number(const Belief& belief) {
  const auto [entry, fresh] =
      numbers_.try_emplace(identity(belief, grid_), static_cast<StateId>(beliefs_.size()));
  if (fresh) {
    beliefs_.push_back(belief);
    summaries_.push_back(summarise(belief, task_));
  }
  return entry->second;
}

}  // namespace tenon::planner
