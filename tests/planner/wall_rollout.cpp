#include "tests/planner/wall_rollout.h"

#include <algorithm>
#include <cmath>

namespace tenon::planner {

RolloutResult WallRollout::simulate(const Particle& particle, const MoveParameters& move,
                                    std::int64_t step_us, std::vector<TraceSample>* trace) {
  (void)trace;
  RolloutResult result;
  if (particle.pose.position_m.x() > world_.broken_beyond_x_m) {
    result.failure = "the physics broke down";
    return result;
  }
  Vector3 way_m = move.displacement.head<3>();
  if (step_us < world_.short_step_us) way_m.x() *= world_.x_gain_at_short_step;
  if (way_m.x() != 0.0) {
    way_m.x() += std::copysign(world_.x_gain_late_mps * particle.physics.latency_s, way_m.x());
  }
  ContactSignature signature = particle.signature;
  for (int axis = 0; axis < 3; ++axis) {
    const int environment = signature.sign(axis);
    if (environment * way_m[axis] < 0.0) way_m[axis] = 0.0;
    if (environment * way_m[axis] > 0.0) {
      signature.bits &= static_cast<std::uint16_t>(~ContactSignature::bit(axis, environment));
    }
  }
  const auto [low_m, high_m] = walls(particle.pose.position_m, particle.environment.orientation);
  // The nearest wall along the way stops everything.
  double part = 1.0;
  int stopping_axis = -1;
  for (int axis = 0; axis < 3; ++axis) {
    if (way_m[axis] == 0.0) continue;
    const double wall_m = way_m[axis] > 0.0 ? high_m[axis] : low_m[axis];
    const double room = (wall_m - particle.pose.position_m[axis]) / way_m[axis];
    if (room < part) {
      part = std::max(0.0, room);
      stopping_axis = axis;
    }
  }
  result.valid = true;
  result.move.outcome = Outcome::kReached;
  result.move.pose = particle.pose;
  result.move.pose.position_m += part * way_m;
  if (stopping_axis >= 0) {
    result.move.outcome = Outcome::kContact;
    const bool up = way_m[stopping_axis] > 0.0;
    result.move.pose.position_m[stopping_axis] = up ? high_m[stopping_axis] : low_m[stopping_axis];
    signature.bits |= ContactSignature::bit(stopping_axis, up ? -1 : +1);
    result.touching = {up ? "point-high" : "point-low"};
  }
  result.move.signature = signature;
  result.move.travelled = displacement_between(particle.pose, result.move.pose);
  return result;
}

WallRollout::Walls WallRollout::walls(const Vector3& from_m, const Eigen::Quaterniond& turn) const {
  Walls walls{world_.low_m, world_.high_m};
  const double y_m = from_m.y();
  if (y_m > world_.ledge_from_y_m && y_m < world_.ledge_to_y_m) walls.low_m.x() += world_.ledge_m;
  if (rotation_vector(turn).norm() > world_.narrow_beyond_tilt_rad) {
    walls.low_m.x() += world_.narrower_m;
    walls.high_m.x() -= world_.narrower_m;
  }
  const bool before_mouth = y_m <= world_.mouth_y_m;
  const bool beside = from_m.x() < world_.slot_from_x_m || from_m.x() > world_.slot_to_x_m;
  if (before_mouth && beside) walls.high_m.y() = std::min(walls.high_m.y(), world_.mouth_y_m);
  if (!before_mouth) {
    walls.low_m.x() = world_.slot_from_x_m;
    walls.high_m.x() = world_.slot_to_x_m;
  }
  return walls;
}

bool WallRollout::in_collision(const Pose& tool_pose) {
  const Vector3& p = tool_pose.position_m;
  const auto [low_m, high_m] = walls(p, tool_pose.orientation);
  return (p.array() < low_m.array()).any() || (p.array() > high_m.array()).any();
}

}  // namespace tenon::planner
