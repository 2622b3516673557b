#pragma once
// The lattice of beliefs as a search graph: numbers for beliefs, costs and heuristics for edges.

#include <map>
#include <optional>
#include <vector>

#include "planner/belief/belief_summary.h"
#include "planner/belief/successor.h"
#include "planner/search/attractors.h"
#include "planner/search/search_graph.h"

namespace tenon::planner {

/// Grows as it is asked. Keeps its states, and the engine its rollouts, from one search to the
/// next. One thread at a time.
class BeliefGraph final : public SearchGraph {
 public:
  /// task and succ must outlive this.
  BeliefGraph(const Task& task, const Belief& start, Attractors attractors, SuccessorEngine& succ);

  [[nodiscard]] StateId start() const override { return 0; }
  [[nodiscard]] bool is_goal(StateId state) const override;
  [[nodiscard]] std::vector<Edge> successors(StateId state) override;
  [[nodiscard]] std::size_t inadmissible_count() const override {
    return attractors_.guides.size();
  }
  [[nodiscard]] double heuristic(std::size_t v, StateId state) const override;

  [[nodiscard]] std::size_t size() const { return beliefs_.size(); }
  [[nodiscard]] const Belief& belief(StateId state) const { return beliefs_[state]; }
  [[nodiscard]] const BeliefSummary& summary(StateId state) const { return summaries_[state]; }
  /// The displacement of an action in a state.
  [[nodiscard]] Vector6 displacement(StateId state, int label) const;

 private:
  [[nodiscard]] std::vector<Primitive> primitives(StateId state) const;
  /// Straight to goal attractor `goal`.
  [[nodiscard]] std::optional<Primitive> direct(StateId state, std::size_t goal) const;
  StateId number(const Belief& belief);

  const Task& task_;
  Grid grid_;
  Attractors attractors_;
  SuccessorEngine& succ_;
  std::vector<Primitive> steps_;
  std::vector<Belief> beliefs_;
  std::vector<BeliefSummary> summaries_;
  std::map<BeliefKey, StateId> numbers_;
};

}  // namespace tenon::planner
