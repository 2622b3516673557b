#include "planner/searched_graph.h"

#include <algorithm>
#include <utility>

#include "planner/belief/belief.h"
#include "shared/task/pose_error.h"

namespace tenon::planner {
namespace {

// A chain that stays this close to the search's particles has done as they did.
constexpr double kForeseen_m = 1e-4;
// Every particle is simulated in every move.
constexpr std::size_t kOthersMax = 8;

bool same_start(const Particle& a, const Particle& b) {
  return a.pose == b.pose && a.environment == b.environment && a.physics == b.physics;
}

}  // namespace

SearchedGraph::SearchedGraph(const Task& task, Belief start, Attractors attractors,
                             SuccessorEngine& succ)
    : task_(task),
      belief_(std::move(start)),
      middle_m_(mean_pose(belief_).position_m),
      attractors_(std::move(attractors)),
      succ_(succ) {
  graph_.emplace(task_, belief_, attractors_, succ_);
}

std::vector<Vector6> SearchedGraph::displacements(const std::vector<PathEdge>& path) const {
  std::vector<Vector6> displacements;
  displacements.reserve(path.size());
  for (const PathEdge& edge : path) {
    displacements.push_back(graph_->displacement(edge.from, edge.label));
  }
  return displacements;
}

void SearchedGraph::begin_from(Belief start) {
  belief_ = std::move(start);
  middle_m_ = mean_pose(belief_).position_m;
  states_before_ += graph_->size();
  graph_.emplace(task_, belief_, attractors_, succ_);
}

bool SearchedGraph::add(const Particle& start) {
  if (known(start) != belief_.particles.end()) return false;
  belief_.particles.push_back(start);
  states_before_ += graph_->size();
  graph_.emplace(task_, belief_, attractors_, succ_);
  return true;
}

std::size_t SearchedGraph::add_starts(const Refutation& refutation) {
  const std::vector<Particle>& others = refutation.others;
  const std::size_t some = std::min(others.size(), kOthersMax);
  std::size_t added = 0;
  const auto gain = [&](const Particle& start) {
    if (!add(start)) return;
    ++added;
    if (task_.motion.carried_axes) (void)add(opposite(start));
  };
  gain(refutation.chain.start);
  for (std::size_t i = 0; i < some; ++i) gain(others[i * others.size() / some]);
  return added;
}

Particle SearchedGraph::opposite(const Particle& start) const {
  Particle other = start;
  other.pose.position_m = 2.0 * middle_m_ - start.pose.position_m;
  Vector6 turn = Vector6::Zero();
  turn.tail<3>() = -rotation_vector(start.environment.orientation);
  other.environment = environment_pose(turn, task_.error_about_m);
  return other;
}

std::vector<Particle>::const_iterator SearchedGraph::known(const Particle& start) const {
  return std::find_if(belief_.particles.begin(), belief_.particles.end(),
                      [&](const Particle& particle) { return same_start(particle, start); });
}

std::optional<std::size_t> SearchedGraph::learn(const Refutation& refutation,
                                                const std::vector<PathEdge>& path) {
  if (add(refutation.chain.start)) return std::nullopt;
  const auto known_at = known(refutation.chain.start);
  const auto particle = static_cast<std::size_t>(known_at - belief_.particles.begin());
  const std::size_t step =
      refutation.step ? *refutation.step : departure(refutation.chain, particle, path);
  succ_.refuse(graph_->belief(path[step].from).particles[particle],
               graph_->displacement(path[step].from, path[step].label));
  return step;
}

std::size_t SearchedGraph::departure(const Chain& chain, std::size_t particle,
                                     const std::vector<PathEdge>& path) const {
  for (std::size_t i = 0; i < chain.moves.size(); ++i) {
    const Particle& foreseen = graph_->belief(path[chain.steps[i]].to).particles[particle];
    if (chain.moves[i].signature != foreseen.signature ||
        displacement_between(foreseen.pose, chain.moves[i].pose).norm() > kForeseen_m) {
      return chain.steps[i];
    }
  }
  return chain.steps.back();
}

}  // namespace tenon::planner
