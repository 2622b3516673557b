#pragma once
// One world out of an experiment's ranges, and what task and cell really are in it. The draw is the
// truth's alone: encoders and CAN do not reveal it. Offline.

#include <cstdint>
#include <optional>
#include <vector>

#include "shared/cell/cell.h"
#include "shared/experiment/world_ranges.h"
#include "shared/task/task.h"
#include "sim/cell/virtual_arm/drive_friction.h"

namespace tenon::sim {

/// The default is the world as planner and executor believe it to be.
struct WorldDraw {
  std::optional<double> friction;               ///< unset: the task's nominal
  std::optional<double> contact_stiffness_Npm;  ///< unset: the cell's
  double clearance_m = 0.0;
  std::vector<Vector3> held_size_error_m;  ///< a shape each, or none at all
  std::vector<Vector3> environment_size_error_m;
  Vector6 task_in_base_error = Vector6::Zero();      ///< base axes
  Vector6 tool_in_flange_error = Vector6::Zero();    ///< flange axes
  Vector6 sensor_in_flange_error = Vector6::Zero();  ///< flange axes
  double payload_mass_error_kg = 0.0;
  Vector3 payload_com_error_m = Vector3::Zero();  ///< axes of the sensor as the cell has it
  double servo_stiffness_factor = 1.0;
  double extra_delay_s = 0.0;
  double backlash_m = 0.0;
  double backlash_rad = 0.0;
  std::vector<DriveFriction> drive_friction;  ///< a joint each, or none at all
  double sensor_noise_factor = 1.0;
  double force_drift_N_sqrts = 0.0;
  double torque_drift_Nm_sqrts = 0.0;
};

/// Equal ranges, task and seed give equal worlds, on every platform. Each quantity draws from a
/// stream of its own, so that a range added or changed leaves the others' draws alone.
[[nodiscard]] WorldDraw draw_world(const WorldRanges& ranges, const Task& task, std::uint64_t seed);

/// The cell as it really is: frames, payload, contact, servos, and the sensor's noise.
/// @throws InputError where no payload is left
[[nodiscard]] Cell real_cell(const Cell& cell, const WorldDraw& draw);

/// The task as it really is: sizes and nominal friction.
/// @throws InputError where a shape vanishes
[[nodiscard]] Task real_task(const Task& task, const WorldDraw& draw);

}  // namespace tenon::sim
