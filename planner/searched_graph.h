#pragma once
// The graph that is searched round after round, and what refuted paths teach it: particles that it
// gains, moves that it loses.

#include <cstddef>
#include <optional>
#include <vector>

#include "planner/belief/belief.h"
#include "planner/belief/successor.h"
#include "planner/judge/refutation.h"
#include "planner/search/attractors.h"
#include "planner/search/belief_graph.h"
#include "planner/search/mha_search.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// One thread at a time.
class SearchedGraph {
 public:
  /// task and succ must outlive this.
  SearchedGraph(const Task& task, Belief start, Attractors attractors, SuccessorEngine& succ);

  [[nodiscard]] BeliefGraph& graph() { return *graph_; }
  /// Those of the graphs before, too.
  [[nodiscard]] std::size_t states() const { return states_before_ + graph_->size(); }
  /// One a step of a path that was found in graph().
  [[nodiscard]] std::vector<Vector6> displacements(const std::vector<PathEdge>& path) const;

  /// What is known of the start: its particles, and the starts that refuted a path.
  [[nodiscard]] const Belief& start() const { return belief_; }
  /// Another start, and none that refuted a path: graph() begins anew.
  void begin_from(Belief start);
  /// Makes a start a particle: graph() begins anew. @return false where it is one already
  bool add(const Particle& start);
  /// Likewise the start of a refutation's chain and, evenly among its others, up to eight: what is
  /// made anew for these holds for most of those between them. Where moves are aimed at what the
  /// mean of all has to do, each comes with the one that is as far off the other way: starts that
  /// miss are on one side, and a way made for a mean beside the middle leads nobody.
  /// @return how many of those that missed are new
  std::size_t add_starts(const Refutation& refutation);

  /// A chain from a start that the search did not know of makes that start a particle: graph()
  /// begins anew. Otherwise the search was wrong about a move, and does without it.
  /// @return the step whose move is gone; empty where there is a new particle
  std::optional<std::size_t> learn(const Refutation& refutation, const std::vector<PathEdge>& path);

 private:
  [[nodiscard]] Particle opposite(const Particle& start) const;
  [[nodiscard]] std::vector<Particle>::const_iterator known(const Particle& start) const;
  /// The step in which a chain leaves what the search had foreseen for its particle; the last one
  /// where it does not.
  [[nodiscard]] std::size_t departure(const Chain& chain, std::size_t particle,
                                      const std::vector<PathEdge>& path) const;

  const Task& task_;
  Belief belief_;
  Vector3 middle_m_;  ///< of the start's particles, before there were others
  Attractors attractors_;
  SuccessorEngine& succ_;
  std::optional<BeliefGraph> graph_;
  std::size_t states_before_ = 0;
};

}  // namespace tenon::planner
