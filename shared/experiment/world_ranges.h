#pragma once
// How far the world of an experiment may differ from what task and cell file say: what
// sim/experiments/*.yaml hold. Plain data; sim/cell/virtual_arm/world_draw.h draws from it. Planner
// and executor never see it.

#include <cstdint>
#include <optional>
#include <string>

namespace tenon {

/// How a number is drawn.
struct Spread {
  double low = 0.0;  ///< evenly from [low, high]
  double high = 0.0;
  /// Where not 0: instead, normally about 0 with this standard deviation, never beyond three of it.
  double sigma = 0.0;
};

/// Friction of the drives: Coulomb, viscous at full speed, and hysteresis together.
struct DriveFrictionRange {
  Spread share;  ///< of a drive's rated effort, each drive by itself
  /// Every world has the same arm, drawn from this; unset: another arm in each.
  std::optional<std::uint64_t> seed;
};

/// The default of everything is no difference.
struct WorldRanges {
  std::string name;
  // Contact.
  std::optional<Spread> friction;               ///< unset: the task's nominal
  std::optional<Spread> contact_stiffness_Npm;  ///< unset: the cell's
  /// Geometry: each shape of the held part is so much smaller than the task says; negative: larger.
  Spread clearance_m;
  Spread size_error_m;  ///< of every size of every shape by itself
  // Calibration: how far the frames of the cell file are off, each axis by itself.
  Spread task_in_base_error_m;
  Spread task_in_base_error_rad;
  Spread tool_in_flange_error_m;
  Spread tool_in_flange_error_rad;
  Spread sensor_in_flange_error_m;
  Spread sensor_in_flange_error_rad;
  // Payload.
  Spread payload_mass_error_kg;
  Spread payload_com_error_m;  ///< each axis by itself
  // Servos.
  Spread servo_stiffness_factor{.low = 1.0, .high = 1.0};
  Spread extra_delay_s;                              ///< of the servos behind their demand
  Spread backlash_m;                                 ///< of prismatic joints
  Spread backlash_rad;                               ///< of revolute joints
  std::optional<DriveFrictionRange> drive_friction;  ///< unset: none
  // Force/torque sensor.
  Spread sensor_noise_factor{.low = 1.0, .high = 1.0};
  Spread force_drift_N_sqrts;  ///< random walk of the bias: standard deviation after 1 s
  Spread torque_drift_Nm_sqrts;
};

}  // namespace tenon
