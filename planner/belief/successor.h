#pragma once
// SUCC(belief, primitive): every particle is moved by the guarded move until its own outcome.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "planner/belief/belief.h"
#include "planner/belief/move_reach.h"
#include "planner/belief/primitives.h"
#include "planner/belief/rollout_pool.h"

namespace tenon::planner {

/// Remembers every rollout by (particle, primitive). Particles of equal contacts within 10 um and
/// 1e-5 rad count as one and are simulated once; certification repeats all of them apart. Results
/// depend on the order of calls, never on the number of threads. One thread at a time.
class SuccessorEngine {
 public:
  struct Counters {
    std::uint64_t rollouts = 0;   ///< simulated moves
    std::uint64_t memo_hits = 0;  ///< moves that were already known
    std::uint64_t failures = 0;   ///< moves that do not exist
  };

  /// @param pool must outlive this  @param move everything of a move but its displacement
  SuccessorEngine(RolloutPool& pool, const MoveParameters& move, std::int64_t step_us);

  /// From now on moves that the arm cannot make do not exist. @param reach outlives this
  void within(MoveReach& reach) { reach_ = &reach; }
  /// Null where no arm is asked.
  [[nodiscard]] MoveReach* reach() const { return reach_; }

  /// One belief for each primitive, in order. Empty where a particle's rollout failed or timed out,
  /// or left it resting at an edge (edge_rest.h), or the arm cannot make it: such a move does not
  /// exist. All rollouts that are missing run as one batch.
  [[nodiscard]] std::vector<std::optional<Belief>> successors(
      const Belief& belief, std::span<const Primitive> primitives);

  /// The move, none that is plain, does not exist any more, as if its rollout had failed: a finer
  /// simulation contradicts it.
  void refuse(const Particle& particle, const Vector6& displacement);

  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  using Key = std::vector<std::int64_t>;
  struct Ended {
    Particle particle;
    Vector6 travelled;
  };
  using End = std::optional<Ended>;
  struct Job {
    Particle particle;
    Vector6 displacement;
    bool plain = false;
    End* end = nullptr;
  };

  [[nodiscard]] static Key key_of(const Particle& particle, const Vector6& displacement,
                                  bool plain);
  [[nodiscard]] End simulate(Rollout& rollout, const Job& job) const;

  /// One for each primitive, each the end of every particle; in that order.
  [[nodiscard]] std::vector<const End*> ends_of(const Belief& belief,
                                                std::span<const Primitive> primitives);
  /// @return whether the arm can make the move; it is with the successor then
  [[nodiscard]] bool carry_arm(const ArmPlace& from, const Belief& belief,
                               const Primitive& primitive, const End* const* ends,
                               Belief& successor);

  RolloutPool& pool_;
  MoveParameters move_;
  std::int64_t step_us_;
  MoveReach* reach_ = nullptr;
  std::map<Key, End> memo_;
  Counters counters_;
};

}  // namespace tenon::planner
