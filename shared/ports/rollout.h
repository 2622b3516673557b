#pragma once
// The planner's view of physics: one guarded move of one particle.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "shared/math/pose.h"
#include "shared/motion/guarded_move.h"
#include "shared/task/pose_error.h"

namespace tenon {

/// Values of the uncertain physical parameters.
struct PhysicalParameters {
  double friction = 0.3;
  double contact_stiffness_Npm = 5e4;  ///< of parts and arm in series
  double oversize_m = 0.0;  ///< by which every size of the held part exceeds what is drawn
  /// Of the arm, (n + 1/2) T + tau_arm: by which what the move sees of pose and wrench is old.
  double latency_s = 0.0;
  /// From where the arm takes its force sensor to be to where that measures, in the tool's axes.
  Vector3 sensor_error_m = Vector3::Zero();

  friend bool operator==(const PhysicalParameters&, const PhysicalParameters&) = default;
};

/// A particle: a tool at rest. Pose and signature determine its setpoint.
///
/// Its frame has the axes that the arm goes by, those of the task frame as it was said to be, in
/// which moves are made and wrenches felt; its origin goes with the environment's error of
/// position, since only where the two stand to each other counts. So an environment that is moved
/// but not turned stands at the identity, whatever its error.
struct Particle {
  Pose pose;  ///< tool
  ContactSignature signature;
  PhysicalParameters physics;
  Pose environment;  ///< the task frame as it really stands

  /// The tool in the task frame as it really stands.
  [[nodiscard]] Pose tool() const { return seen_from(environment, pose); }

  friend bool operator==(const Particle&, const Particle&) = default;
};

/// One instant of a rollout, as a recording of the executor has it.
struct TraceSample {
  GuardedMove::Input input;
  GuardedMove::Setpoint setpoint;
};

struct RolloutResult {
  /// False: the simulation itself failed (solver messages, not at rest, tunnelling) and the rest
  /// means nothing. `failure` says why.
  bool valid = false;
  std::string failure;
  GuardedMove::Result move;
  /// Which held shape touches which environment shape at the end, for people to look at.
  std::vector<std::string> touching;
};

/// Deterministic: equal arguments give equal results, bit for bit, in any instance, in any order,
/// on any thread. An instance is used by one thread at a time.
class Rollout {
 public:
  Rollout() = default;
  Rollout(const Rollout&) = delete;
  Rollout& operator=(const Rollout&) = delete;
  virtual ~Rollout() = default;

  /// @param step_us integration step  @param trace filled with every instant where not null
  [[nodiscard]] virtual RolloutResult simulate(const Particle& particle, const MoveParameters& move,
                                               std::int64_t step_us,
                                               std::vector<TraceSample>* trace = nullptr) = 0;

  /// Whether the held part, as large as it may be, overlaps the environment.
  /// @param tool_pose in the task frame as it really stands
  [[nodiscard]] virtual bool in_collision(const Pose& tool_pose) = 0;

  /// Another instance for another thread.
  [[nodiscard]] virtual std::unique_ptr<Rollout> clone() const = 0;
};

}  // namespace tenon
