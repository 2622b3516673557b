#include "planner/belief/successor.h"

#include <bit>

#include "planner/belief/edge_rest.h"

namespace tenon::planner {
namespace {

// Far below anything that a contact or a sensor resolves.
constexpr double kCoincident_m = 10e-6;
constexpr double kCoincident_rad = 1e-5;

}  // namespace

SuccessorEngine::SuccessorEngine(RolloutPool& pool, const MoveParameters& move,
                                 std::int64_t step_us, Edges edges)
    : pool_(pool), move_(move), step_us_(step_us), edges_(edges) {}

SuccessorEngine::Key SuccessorEngine::key_of(const Particle& particle,
                                             const Vector6& displacement) {
  Key key;
  append_cell(particle, kCoincident_m, kCoincident_rad, key);
  for (int axis = 0; axis < 6; ++axis) {
    key.push_back(std::bit_cast<std::int64_t>(displacement[axis]));
  }
  return key;
}

SuccessorEngine::End SuccessorEngine::simulate(Rollout& rollout, const Job& job) const {
  MoveParameters move = move_;
  move.displacement = job.displacement;
  const RolloutResult result = rollout.simulate(job.particle, move, step_us_);
  if (!result.valid || result.move.outcome == Outcome::kTimeout) return std::nullopt;
  const Particle end{result.move.pose, result.move.signature, job.particle.physics,
                     job.particle.environment};
  if (edges_ == Edges::kRefused && rests_at_edge(end, move.compliance.compliant_axes, rollout))
    return std::nullopt;
  return end;
}

void SuccessorEngine::refuse(const Particle& particle, const Vector6& displacement) {
  memo_[key_of(particle, displacement)].reset();
}

std::vector<std::optional<Belief>> SuccessorEngine::successors(
    const Belief& belief, std::span<const Primitive> primitives) {
  std::vector<Job> jobs;
  std::vector<const End*> ends;  // by primitive, then particle; nodes of a map stay where they are
  for (const Primitive& primitive : primitives) {
    for (const Particle& particle : belief.particles) {
      const auto [entry, fresh] = memo_.try_emplace(key_of(particle, primitive.displacement));
      ends.push_back(&entry->second);
      if (fresh) jobs.push_back({particle, primitive.displacement, &entry->second});
    }
  }
  pool_.run(jobs.size(),
            [&](Rollout& rollout, std::size_t i) { *jobs[i].end = simulate(rollout, jobs[i]); });

  counters_.rollouts += jobs.size();
  counters_.memo_hits += ends.size() - jobs.size();
  for (const Job& job : jobs) counters_.failures += job.end->has_value() ? 0U : 1U;

  std::vector<std::optional<Belief>> successors;
  auto end = ends.begin();
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    std::optional<Belief> successor = Belief{};
    for (std::size_t j = 0; j < belief.particles.size(); ++j, ++end) {
      if (!(*end)->has_value()) {
        successor.reset();
      } else if (successor) {
        successor->particles.push_back(***end);
      }
    }
    successors.push_back(std::move(successor));
  }
  return successors;
}

}  // namespace tenon::planner
