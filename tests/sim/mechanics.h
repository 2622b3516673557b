#pragma once
// An oracle for arms: forward kinematics, potential and kinetic energy of rigid bodies, and by
// finite differences what gravity takes to hold and how much mass a joint moves. Shares no code
// with the virtual arm.

#include <Eigen/Geometry>
#include <vector>

#include "shared/cell/cell.h"
#include "shared/ports/arm.h"

namespace tenon::sim {

inline constexpr double kGravity_mps2 = 9.80665;

struct Body {
  double mass_kg;
  Vector3 com_m;
  Eigen::Matrix3d rotation;  ///< of the inertia's axes
  Eigen::Matrix3d inertia_kgm2;
};

/// The oracle: every link and the payload where these joints bring them.
inline std::vector<Body> bodies_at(const Cell& cell, const JointVector& position,
                                   Eigen::Isometry3d* sensor = nullptr) {
  const auto isometry = [](const Pose& pose) {
    Eigen::Isometry3d result(pose.orientation);
    result.translation() = pose.position_m;
    return result;
  };
  std::vector<Body> bodies;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
    const Joint& joint = cell.robot.joints[i];
    pose = pose * isometry(joint.origin);
    if (joint.kind == Joint::Kind::kRevolute) {
      pose = pose * Eigen::AngleAxisd(position[i], joint.axis);
    } else {
      pose = pose * Eigen::Translation3d(position[i] * joint.axis);
    }
    bodies.push_back(
        {joint.link.mass_kg, pose * joint.link.com_m, pose.linear(), joint.link.inertia_kgm2});
  }
  const Eigen::Isometry3d at_sensor = pose * isometry(cell.robot.flange) * isometry(cell.X_FS);
  // The payload is a ball of 50 mm.
  const double ball_kgm2 = 0.4 * cell.payload_mass_kg * 0.05 * 0.05;
  bodies.push_back({cell.payload_mass_kg, at_sensor * cell.payload_com_m, at_sensor.linear(),
                    ball_kgm2 * Eigen::Matrix3d::Identity()});
  if (sensor != nullptr) *sensor = at_sensor;
  return bodies;
}

inline double height_energy_J(const Cell& cell, const JointVector& position) {
  double energy_J = 0.0;
  for (const Body& body : bodies_at(cell, position)) {
    energy_J += body.mass_kg * kGravity_mps2 * cell.up_B.dot(body.com_m);
  }
  return energy_J;
}

inline JointVector shifted(JointVector position, std::size_t joint, double by) {
  position[joint] += by;
  return position;
}

/// What gravity takes to hold: the slope of the potential energy.
inline double gravity_effort(const Cell& cell, const JointVector& position, std::size_t joint) {
  constexpr double kSmall = 1e-5;
  return (height_energy_J(cell, shifted(position, joint, kSmall)) -
          height_energy_J(cell, shifted(position, joint, -kSmall))) /
         (2.0 * kSmall);
}

/// The mass matrix: sums of m v_i v_j + w_i I w_j over the bodies, velocities by differences.
inline Eigen::MatrixXd mass_matrix(const Cell& cell, const JointVector& position) {
  constexpr double kSmall = 1e-5;
  const std::size_t joints = cell.robot.joints.size();
  const std::vector<Body> here = bodies_at(cell, position);
  std::vector<std::vector<Vector3>> linear(joints);
  std::vector<std::vector<Vector3>> angular(joints);
  for (std::size_t i = 0; i < joints; ++i) {
    const std::vector<Body> ahead = bodies_at(cell, shifted(position, i, kSmall));
    const std::vector<Body> behind = bodies_at(cell, shifted(position, i, -kSmall));
    for (std::size_t b = 0; b < here.size(); ++b) {
      linear[i].push_back((ahead[b].com_m - behind[b].com_m) / (2.0 * kSmall));
      const Eigen::AngleAxisd turn(ahead[b].rotation * behind[b].rotation.transpose());
      angular[i].push_back(turn.angle() * turn.axis() / (2.0 * kSmall));
    }
  }
  Eigen::MatrixXd matrix =
      Eigen::MatrixXd::Zero(static_cast<int>(joints), static_cast<int>(joints));
  for (std::size_t i = 0; i < joints; ++i) {
    for (std::size_t j = 0; j < joints; ++j) {
      for (std::size_t b = 0; b < here.size(); ++b) {
        const Eigen::Matrix3d inertia =
            here[b].rotation * here[b].inertia_kgm2 * here[b].rotation.transpose();
        matrix(static_cast<int>(i), static_cast<int>(j)) +=
            here[b].mass_kg * linear[i][b].dot(linear[j][b]) +
            angular[i][b].dot(inertia * angular[j][b]);
      }
    }
  }
  return matrix;
}

}  // namespace tenon::sim
