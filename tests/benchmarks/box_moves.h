#pragma once
// Moves of the box-on-table task: one that touches nothing, one that ends at a wall, and one that
// slides along it.

#include "shared/config/load.h"
#include "shared/ports/rollout.h"
#include "shared/task/task.h"
#include "tests/support/places.h"

namespace tenon::bench {

enum class Move { kFree, kContact, kSlide };

[[nodiscard]] inline const Task& box_task() {
  static const Task task = load_task(tests::in_tree("planner/tasks/box_on_table_2d.yaml"));
  return task;
}

[[nodiscard]] inline MoveParameters box_move(Move move) {
  const Task& task = box_task();
  MoveParameters parameters;
  parameters.speeds = task.motion.speeds;
  parameters.thresholds = task.motion.thresholds;
  parameters.timeout_us = task.motion.timeout_us;
  parameters.trigger_mask = task.motion.trigger_mask;
  parameters.compliance = task.compliance;
  parameters.force_limit_N = task.force_limit_N;
  parameters.torque_limit_Nm = task.torque_limit_Nm;
  parameters.displacement[move == Move::kSlide ? 1 : 0] = move == Move::kContact ? -0.2 : 0.1;
  parameters.slow_from_m = 0.05;
  return parameters;
}

/// Where the move starts: in the open 0.05 m off the wall at -x, or resting against that wall.
[[nodiscard]] inline Particle box_particle(Move move, Rollout& rollout) {
  Particle particle;
  particle.pose.position_m = {-0.40, 0.0, 0.002};
  particle.physics = {box_task().friction.nominal, box_task().contact_stiffness_Npm};
  if (move != Move::kSlide) return particle;
  const RolloutResult touched =
      rollout.simulate(particle, box_move(Move::kContact), box_task().rollout_step_us);
  particle.pose = touched.move.pose;
  particle.signature = touched.move.signature;
  return particle;
}

/// What the move must end with, or the measurement means nothing.
[[nodiscard]] inline Outcome box_outcome(Move move) {
  return move == Move::kContact ? Outcome::kContact : Outcome::kReached;
}

}  // namespace tenon::bench
