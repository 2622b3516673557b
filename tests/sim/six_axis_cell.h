#pragma once
// A six-axis arm with the joints, masses and efforts of the Schunk LWA 4P, written out by hand, and
// balls and rods for its links; a payload beyond the sensor. Nothing to touch.

#include <array>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "shared/cell/cell.h"
#include "shared/task/task.h"

namespace tenon::sim {

inline Eigen::Quaterniond rpy(double roll_rad, double pitch_rad, double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Vector3::UnitZ()) *
         Eigen::AngleAxisd(pitch_rad, Vector3::UnitY()) *
         Eigen::AngleAxisd(roll_rad, Vector3::UnitX());
}

inline std::vector<Joint> six_joints() {
  constexpr double kHalfTurn_rad = std::numbers::pi;
  constexpr double kQuarterTurn_rad = std::numbers::pi / 2;
  const std::array<Pose, 6> origins = {{
      {{0.0, 0.0, 0.0}, rpy(0.0, 0.0, 0.0)},
      {{0.0, 0.0, 0.0}, rpy(kQuarterTurn_rad, 0.0, 0.0)},
      {{0.0, 0.350, 0.0}, rpy(0.0, kHalfTurn_rad, 0.0)},
      {{0.0, 0.0, 0.0}, rpy(-kQuarterTurn_rad, kHalfTurn_rad, 0.0)},
      {{0.0, 0.005263, 0.305}, rpy(kQuarterTurn_rad, 0.0, kHalfTurn_rad)},
      {{0.0, 0.0, 0.0}, rpy(-kQuarterTurn_rad, 0.0, 0.0)},
  }};
  const std::array<double, 6> masses_kg = {0.294, 1.683, 2.1, 1.683, 0.807, 0.819};
  const std::array<Vector3, 6> coms_m = {{{0.0, 0.0, -0.05},
                                          {0.0, 0.17, 0.03},
                                          {0.0, -0.02, 0.06},
                                          {0.0, 0.01, 0.15},
                                          {0.0, 0.02, 0.03},
                                          {0.0, 0.0, 0.06}}};
  const std::array<Vector3, 6> inertias_kgm2 = {{{0.0006, 0.0006, 0.0005},
                                                 {0.020, 0.0025, 0.020},
                                                 {0.0060, 0.0060, 0.0040},
                                                 {0.015, 0.015, 0.0025},
                                                 {0.0012, 0.0010, 0.0012},
                                                 {0.0010, 0.0010, 0.0006}}};
  const std::array<double, 6> efforts_Nm = {370.0, 370.0, 176.0, 176.0, 41.6, 20.1};
  const std::array<double, 6> stiffnesses_Nmpr = {3e4, 3e4, 2e4, 1.5e4, 6e3, 4e3};

  std::vector<Joint> joints;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    Joint joint;
    joint.name = "arm_" + std::to_string(i + 1);
    joint.kind = Joint::Kind::kRevolute;
    joint.origin = origins[i];
    joint.axis = Vector3::UnitZ();
    joint.node = static_cast<std::uint8_t>(i + 3);
    joint.counts_per_unit = 1000.0 * 180.0 / std::numbers::pi;
    joint.upper = i == 2 ? 2.714 : 2.967;
    joint.lower = -joint.upper;
    joint.speed_max = 1.26;
    joint.acceleration_max = 5.0;
    joint.effort_max = joint.rated_effort = efforts_Nm[i];
    joint.following_error_max = 0.05;
    joint.stiffness = stiffnesses_Nmpr[i];
    joint.link.mass_kg = masses_kg[i];
    joint.link.com_m = coms_m[i];
    joint.link.inertia_kgm2 = inertias_kgm2[i].asDiagonal();
    joints.push_back(joint);
  }
  return joints;
}

inline Cell six_axis_cell() {
  Cell cell;
  cell.name = "test";
  cell.robot.name = "six_axis";
  cell.robot.joints = six_joints();
  cell.robot.flange.position_m = {0.0, 0.0, 0.10};
  cell.robot.sensor.node = 9;
  cell.robot.sensor.force_per_count_N = 0.01;
  cell.robot.sensor.torque_per_count_Nm = 0.0005;
  cell.robot.sensor.force_range_N = 300.0;
  cell.robot.sensor.torque_range_Nm = 15.0;
  cell.X_FS = {{0.0, 0.0, 0.02}, rpy(0.3, 0.0, 0.7)};
  cell.X_FP = {{0.0, 0.0, 0.20}, rpy(std::numbers::pi, 0.0, 0.0)};
  cell.payload_mass_kg = 0.5;
  cell.payload_com_m = {0.02, -0.01, 0.08};
  return cell;
}

/// Something to hold and something far away.
inline Task empty_task() {
  Task task;
  task.name = "empty";
  task.held = {{"cube", Shape::Kind::kBox, {0.02, 0.02, 0.02}, {}}};
  task.environment = {
      {"far", Shape::Kind::kBox, {0.1, 0.1, 0.1}, {{0.0, 0.0, -50.0}, {1, 0, 0, 0}}}};
  Start start;
  start.name = "start";
  task.starts = {start};
  return task;
}

}  // namespace tenon::sim
