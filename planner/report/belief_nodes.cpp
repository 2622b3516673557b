#include "planner/report/belief_nodes.h"

#include <algorithm>

#include "planner/belief/belief.h"

namespace tenon::planner {

std::vector<BeliefNode> nodes_of(const std::vector<Chain>& chains, const Task& task) {
  std::vector<BeliefNode> nodes;
  if (chains.empty()) return nodes;
  std::size_t count = chains.front().moves.size();
  for (const Chain& chain : chains) count = std::min(count, chain.moves.size());
  for (std::size_t i = 0; i <= count; ++i) {
    Belief belief;
    for (const Chain& chain : chains) {
      belief.particles.push_back({chain.tool(i), {}, {}, {}});
    }
    BeliefNode node;
    const Pose mean = mean_pose(belief);
    for (const Particle& particle : belief.particles) {
      node.spread += displacement_between(mean, particle.pose).cwiseAbs2();
    }
    node.spread = (node.spread / static_cast<double>(chains.size())).cwiseSqrt();
    node.uncertainty_m2 = uncertainty(belief, metric_of(task));
    nodes.push_back(node);
  }
  return nodes;
}

std::vector<Chain> finished(const Validation& validation) {
  std::vector<Chain> chains;
  for (const Draw& draw : validation.draws) {
    if (draw.chain.done) chains.push_back(draw.chain);
  }
  return chains;
}

}  // namespace tenon::planner
