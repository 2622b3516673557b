#pragma once
// An exact kinematic double of the rollout port: a point between axis-parallel walls.
//
// It moves straight, component by component, and stops where it meets a wall it does not rest on
// yet. What GuardedMove does to a displacement holds here too: a component into a held contact is
// dropped, and a contact that is left makes no outcome. Friction, stiffness, speeds and the step
// are ignored unless a knob says otherwise. One thread at a time.

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "shared/ports/rollout.h"

namespace tenon::planner {

class WallRollout final : public Rollout {
 public:
  struct World {
    Vector3 low_m = Vector3::Constant(-std::numeric_limits<double>::infinity());
    Vector3 high_m = Vector3::Constant(std::numeric_limits<double>::infinity());
    /// Displacements along x get this much longer at steps of less than shortest_step_us.
    double x_gain_at_short_step = 1.0;
    std::int64_t short_step_us = 0;
    /// Displacements along x get this much longer for every second of the particle's latency.
    double x_gain_late_mps = 0.0;
    /// Between these y the low wall along x stands this much farther in.
    double ledge_m = 0.0;
    double ledge_from_y_m = 0.0;
    double ledge_to_y_m = 0.0;
    /// Moves that would start beyond this x fail, as physics that broke down.
    double broken_beyond_x_m = std::numeric_limits<double>::infinity();
    /// Where the environment is turned by more, the walls along x stand this much farther in.
    double narrow_beyond_tilt_rad = std::numeric_limits<double>::infinity();
    double narrower_m = 0.02;
    /// At this y a wall stands across, and in it a slot between these x leads on.
    double mouth_y_m = std::numeric_limits<double>::infinity();
    double slot_from_x_m = 0.0;
    double slot_to_x_m = 0.0;
  };

  explicit WallRollout(const World& world) : world_(world) {}

  [[nodiscard]] RolloutResult simulate(const Particle& particle, const MoveParameters& move,
                                       std::int64_t step_us,
                                       std::vector<TraceSample>* trace) override;
  [[nodiscard]] bool in_collision(const Pose& tool_pose) override;
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override {
    return std::make_unique<WallRollout>(world_);
  }

 private:
  struct Walls {
    Vector3 low_m;
    Vector3 high_m;
  };
  /// As a tool finds them from where it is. @param turn of the environment to the tool
  [[nodiscard]] Walls walls(const Vector3& from_m, const Eigen::Quaterniond& turn) const;

  World world_;
};

}  // namespace tenon::planner
