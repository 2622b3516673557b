#pragma once
// Guarded moves of a particle in ODE: the planner's physics.

#include <memory>

#include "shared/ports/rollout.h"
#include "shared/task/task.h"
#include "sim/physics/surfaces/mesh_distances.h"

namespace tenon::sim {

/// The compliant tool of a task among its environment. Owns one ODE world; one thread at a time.
class OdeRollout final : public Rollout {
 public:
  /// @param distances exact is the truth; sampled is for searching, between meshes, and is no
  /// proof of anything
  explicit OdeRollout(const Task& task, MeshDistances distances = MeshDistances::kExact);
  ~OdeRollout() override;

  [[nodiscard]] RolloutResult simulate(const Particle& particle, const MoveParameters& move,
                                       std::int64_t step_us,
                                       std::vector<TraceSample>* trace) override;
  [[nodiscard]] bool in_collision(const Pose& tool_pose) override;
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override;

 private:
  struct Physics;
  Task task_;
  MeshDistances distances_;
  std::unique_ptr<Physics> physics_;
};

}  // namespace tenon::sim
