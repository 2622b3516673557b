#pragma once
// What really happened in the virtual cell, and what no encoder or frame reveals. Plain data.

#include <cstdint>
#include <string>
#include <vector>

#include "shared/math/pose.h"
#include "shared/plan/goal_axes.h"
#include "sim/cell/virtual_arm/world_draw.h"

namespace tenon::sim {

struct TruthEvent {
  double time_s = 0.0;  ///< since the cell was switched on
  std::string what;
};

struct DriveTruth {
  std::string joint;
  std::uint8_t node = 0;
  std::string state;  ///< of the CiA 402 machine
  bool brake_engaged = true;
  bool operational = false;  ///< NMT
  std::uint16_t error_code = 0;
  double position = 0.0;  ///< m or rad
};

struct Truth {
  std::string task;
  std::string start;
  std::uint64_t seed = 0;
  double time_s = 0.0;
  Vector6 offset = Vector6::Zero();  ///< of the environment, in task axes, m and rad
  WorldDraw world;                   ///< how else the real world differed, friction as it was
  Pose tool;                         ///< in the frame of the environment as it really stands
  Vector6 error = Vector6::Zero();   ///< from the goal to `tool`, m and rad
  double error_norm_m = 0.0;
  double error_norm_rad = 0.0;
  double goal_tolerance_m = 0.0;
  GoalAxes goal_axes;                ///< that do not count in it
  bool within_tolerance = false;     ///< see shared/task/inserted.h
  double contact_force_N_max = 0.0;  ///< of the environment on the part, instantaneous
  std::vector<std::string> touching;
  std::vector<DriveTruth> drives;
  std::uint32_t faults = 0;           ///< drives that entered fault
  std::uint64_t solver_messages = 0;  ///< not 0: the physics is not to be believed
  std::uint64_t frames_not_sent = 0;
  // Where the cell runs on its own clock:
  std::uint64_t frames_lost = 0;  ///< by clients that read too slowly, each on its own
  std::uint64_t wakes = 0;
  std::uint64_t wakes_late = 0;  ///< by more than a millisecond
  double late_max_ms = 0.0;
  std::vector<TruthEvent> events;  ///< the first 500
};

/// For people, two lines: how far off the environment was, how far from the goal the part ended.
[[nodiscard]] std::string describe(const Truth& truth);

/// Pretty JSON; sim/README.md documents the keys.
[[nodiscard]] std::string truth_json(const Truth& truth);

}  // namespace tenon::sim
