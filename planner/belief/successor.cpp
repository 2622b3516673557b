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
                                 std::int64_t step_us)
    : pool_(pool), move_(move), step_us_(step_us) {}

SuccessorEngine::Key SuccessorEngine::key_of(const Particle& particle, const Vector6& displacement,
                                             bool plain) {
  Key key;
  append_cell(particle, kCoincident_m, kCoincident_rad, key);
  for (int axis = 0; axis < 6; ++axis) {
    key.push_back(std::bit_cast<std::int64_t>(displacement[axis]));
  }
  key.push_back(plain ? 1 : 0);
  return key;
}

SuccessorEngine::End SuccessorEngine::simulate(Rollout& rollout, const Job& job) const {
  MoveParameters move = move_;
  move.displacement = job.displacement;
  move.aligns = move.aligns && !job.plain;
  const RolloutResult result = rollout.simulate(job.particle, move, step_us_);
  if (!result.valid || result.move.outcome == Outcome::kTimeout) return std::nullopt;
  const Particle end{result.move.pose, result.move.signature, job.particle.physics,
                     job.particle.environment};
  if (rests_at_edge(end, move.compliance.compliant_axes, rollout)) return std::nullopt;
  return Ended{end, result.move.travelled};
}

void SuccessorEngine::refuse(const Particle& particle, const Vector6& displacement) {
  memo_[key_of(particle, displacement, false)].reset();
}

std::vector<const SuccessorEngine::End*> SuccessorEngine::ends_of(
    const Belief& belief, std::span<const Primitive> primitives) {
  std::vector<Job> jobs;
  std::vector<const End*> ends;  // nodes of a map stay where they are
  for (const Primitive& primitive : primitives) {
    for (const Particle& particle : belief.particles) {
      const auto& [label, displacement, plain] = primitive;
      const auto [entry, fresh] = memo_.try_emplace(key_of(particle, displacement, plain));
      ends.push_back(&entry->second);
      if (fresh) jobs.push_back({particle, displacement, plain, &entry->second});
    }
  }
  pool_.run(jobs.size(),
            [&](Rollout& rollout, std::size_t i) { *jobs[i].end = simulate(rollout, jobs[i]); });

  counters_.rollouts += jobs.size();
  counters_.memo_hits += ends.size() - jobs.size();
  for (const Job& job : jobs) counters_.failures += job.end->has_value() ? 0U : 1U;
  return ends;
}

bool SuccessorEngine::carry_arm(const ArmPlace& from, const Belief& belief,
                                const Primitive& primitive, const End* const* ends,
                                Belief& successor) {
  ContactSignature held;
  for (const Particle& particle : belief.particles) held.bits |= particle.signature.bits;
  const Vector6 first = reach_->place_at((*ends[0])->particle.pose);
  MoveReach::Travel travel{{(*ends[0])->travelled, (*ends[0])->travelled}, {first, first}};
  bool touches = false;
  for (std::size_t j = 0; j < belief.particles.size(); ++j) {
    travel.way.include((*ends[j])->travelled);
    travel.place.include(reach_->place_at((*ends[j])->particle.pose));
    touches = touches || (*ends[j])->particle.signature.count() > 0;
  }
  successor.arm = reach_->after(from, primitive.displacement, held, travel, touches);
  return successor.arm != nullptr;
}

std::vector<std::optional<Belief>> SuccessorEngine::successors(
    const Belief& belief, std::span<const Primitive> primitives) {
  std::vector<std::optional<Belief>> successors(primitives.size());
  const auto arm = reach_ != nullptr ? reach_->place_of(belief) : nullptr;
  if (reach_ != nullptr && !arm) return successors;
  const std::vector<const End*> ends = ends_of(belief, primitives);
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const End* const* of_move = &ends[i * belief.particles.size()];
    Belief successor;
    for (std::size_t j = 0; j < belief.particles.size() && of_move[j]->has_value(); ++j) {
      successor.particles.push_back((*of_move[j])->particle);
    }
    if (successor.particles.size() < belief.particles.size()) continue;
    if (arm && !carry_arm(*arm, belief, primitives[i], of_move, successor)) continue;
    successors[i] = std::move(successor);
  }
  return successors;
}

}  // namespace tenon::planner
