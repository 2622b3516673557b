#include "executor/sensing/wrench_estimator.h"

#include <algorithm>
#include <cmath>

namespace tenon::executor {
namespace {

// A reading at this share of the range may have been cut off.
constexpr double kSaturation = 0.999;

}  // namespace

WrenchEstimator::WrenchEstimator(const Cell& cell)
    : gravity_T_mps2_(cell.X_BT.orientation.conjugate() * Vector3(-kGravity_mps2 * cell.up_B)),
      X_SP_(compose(inverse(cell.X_FS), cell.X_FP)),
      mass_kg_(cell.payload_mass_kg),
      com_S_m_(cell.payload_com_m),
      force_range_N_(cell.robot.sensor.force_range_N),
      torque_range_Nm_(cell.robot.sensor.torque_range_Nm),
      motion_(1e-6 * cell.robot.cycle_us, cell.robot.response_lag_s,
              std::clamp(cell.robot.measurement_delay_cycles, 0, PayloadMotion::kDelayMax)) {}

Eigen::Quaterniond WrenchEstimator::R_TS(const Pose& X_TP) const {
  return X_TP.orientation * X_SP_.orientation.conjugate();
}

Vector6 WrenchEstimator::payload_wrench(const Vector3& specific_force_mps2) const {
  const Vector3 force_N = mass_kg_ * specific_force_mps2;
  Vector6 wrench;
  wrench << force_N, com_S_m_.cross(force_N);
  return wrench;
}

Vector3 WrenchEstimator::com_acceleration_mps2(const Vector3& to_com_T) const {
  const Vector3 tip_mps2 = motion_.acceleration().head<3>();
  const Vector3 alpha_radps2 = motion_.acceleration().tail<3>();
  const Vector3 omega_radps = motion_.velocity().tail<3>();
  return tip_mps2 + alpha_radps2.cross(to_com_T) + omega_radps.cross(omega_radps.cross(to_com_T));
}

void WrenchEstimator::tare(const Vector6& mean_raw, const Pose& X_TP) {
  bias_ = mean_raw - payload_wrench(R_TS(X_TP).conjugate() * gravity_T_mps2_);
  unloaded_ = mean_raw;
  contact_.setZero();
  external_.setZero();
}

WrenchEstimator::Status WrenchEstimator::update(const Vector6& raw, const Pose& X_TP) {
  if (!raw.allFinite()) return Status::kNotFinite;
  for (int axis = 0; axis < 6; ++axis) {
    const double range = axis < 3 ? force_range_N_ : torque_range_Nm_;
    if (range <= 0.0 || std::abs(raw[axis]) < kSaturation * range) continue;
    axis_ = axis;
    return Status::kSaturated;
  }

  const Eigen::Quaterniond rotation = R_TS(X_TP);
  const Vector3 to_com_T = rotation * (com_S_m_ - X_SP_.position_m);
  const Vector3 com_mps2 = com_acceleration_mps2(to_com_T);
  unloaded_ = bias_ + payload_wrench(rotation.conjugate() * (gravity_T_mps2_ - com_mps2));
  contact_ = raw - unloaded_;
  external_ = at_tool(contact_, X_TP);
  return Status::kGood;
}

Vector6 WrenchEstimator::at_tool(const Vector6& at_sensor, const Pose& X_TP) const {
  const Eigen::Quaterniond rotation = R_TS(X_TP);
  const Vector3 force_N = at_sensor.head<3>();
  const Vector3 torque_Nm = at_sensor.tail<3>() - X_SP_.position_m.cross(force_N);
  Vector6 wrench;
  wrench << rotation * force_N, rotation * torque_Nm;
  return wrench;
}

}  // namespace tenon::executor
