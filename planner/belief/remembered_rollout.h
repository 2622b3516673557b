#pragma once
// Moves that have been simulated are not simulated again.

#include <cstdint>
#include <memory>

#include "shared/ports/rollout.h"

namespace tenon::planner {

/// A plan is tried at several speeds, with its last move or its way in shifted, from the same
/// starts: what comes before a change is the same to the last bit, and so is what a rollout says of
/// it. Clones share what they know, and may be used by one thread each.
class RememberedRollout final : public Rollout {
 public:
  /// @param rollout cloned
  explicit RememberedRollout(const Rollout& rollout);
  ~RememberedRollout() override;

  /// One with a trace is simulated whether it is known or not.
  [[nodiscard]] RolloutResult simulate(const Particle& particle, const MoveParameters& move,
                                       std::int64_t step_us,
                                       std::vector<TraceSample>* trace = nullptr) override;
  [[nodiscard]] bool in_collision(const Pose& tool_pose) override;
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override;

 private:
  class Memory;
  RememberedRollout(const Rollout& rollout, std::shared_ptr<Memory> memory);

  std::unique_ptr<Rollout> rollout_;
  std::shared_ptr<Memory> memory_;
};

}  // namespace tenon::planner
