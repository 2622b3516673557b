#pragma once
// An arm's body whose drives are told by hand, and arms to put on it.

#include <cstddef>
#include <random>
#include <vector>

#include "shared/cell/cell.h"
#include "sim/cell/virtual_arm/arm_body.h"
#include "tests/sim/six_axis_cell.h"

namespace tenon::sim {

inline constexpr double kStep_s = 0.0005;

class ArmBench {
 public:
  explicit ArmBench(const Cell& cell, const JointVector& start,
                    const ArmBody::Parameters& parameters = ArmBody::Parameters())
      : demands(cell.robot.joints.size()), arm(cell, empty_task(), with(parameters, start)) {
    for (std::size_t i = 0; i < demands.size(); ++i) {
      demands[i].position = start[i];
      demands[i].effort_max = cell.robot.joints[i].effort_max;
    }
  }

  void enable() {
    for (ServoJoint::Demand& demand : demands) enable(demand);
  }
  static void enable(ServoJoint::Demand& demand) {
    demand.brake = false;
    demand.powered = true;
  }
  void release_all() {
    for (ServoJoint::Demand& demand : demands) demand.brake = demand.powered = false;
  }
  void run(double duration_s) {
    for (double left_s = duration_s; left_s > 0.5 * kStep_s; left_s -= kStep_s) {
      arm.step(demands, kStep_s);
    }
  }
  [[nodiscard]] JointVector position() const {
    JointVector position{};
    for (std::size_t i = 0; i < demands.size(); ++i) position[i] = arm.joint(i).position;
    return position;
  }

  std::vector<ServoJoint::Demand> demands;
  ArmBody arm;

 private:
  static ArmBody::Parameters with(ArmBody::Parameters parameters, const JointVector& start) {
    parameters.start = start;
    return parameters;
  }
};

inline ArmBody::Parameters without_integral() {
  ArmBody::Parameters parameters;
  parameters.integral_time_s = 0.0;
  return parameters;
}

inline JointVector random_position(const Cell& cell, std::mt19937_64& random) {
  JointVector position{};
  for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
    const Joint& joint = cell.robot.joints[i];
    const double part = static_cast<double>(random() >> 11) * 0x1p-53;
    position[i] = joint.lower + part * (joint.upper - joint.lower);
  }
  return position;
}

/// Links as given, one behind the other along x, turning about y; gravity along -z.
inline Cell pendulum(const std::vector<double>& lengths_m, const std::vector<double>& masses_kg) {
  Cell cell = six_axis_cell();
  cell.robot.joints.resize(lengths_m.size());
  cell.robot.flange = cell.X_FS = cell.X_FP = Pose{};
  for (std::size_t i = 0; i < lengths_m.size(); ++i) {
    Joint& joint = cell.robot.joints[i];
    joint.origin = {{i == 0 ? 0.0 : lengths_m[i - 1], 0.0, 0.0}, {1, 0, 0, 0}};
    joint.axis = Vector3::UnitY();
    joint.lower = -6.0;
    joint.upper = 6.0;
    joint.link.mass_kg = masses_kg[i];
    joint.link.com_m = {lengths_m[i], 0.0, 0.0};
    joint.link.inertia_kgm2 = 1e-3 * Eigen::Matrix3d::Identity();
  }
  cell.payload_mass_kg = 0.01;
  cell.payload_com_m = Vector3::Zero();
  return cell;
}

inline constexpr JointVector kElbow = {0.3, -0.6, 1.1, -0.4, 0.9, 0.5, 0.0};

}  // namespace tenon::sim
