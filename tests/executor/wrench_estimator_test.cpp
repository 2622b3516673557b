// Weight and inertia of a payload on a tool that turns, against their closed forms.

#include "executor/sensing/wrench_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tenon::executor {
namespace {

constexpr double kG_mps2 = 9.80665;

class Draws {
 public:
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1.0p-53;
  }
  Vector3 vector(double most) {
    return {uniform(-most, most), uniform(-most, most), uniform(-most, most)};
  }
  Pose pose() { return {vector(0.5), rotation_of(vector(1.7))}; }

 private:
  std::mt19937_64 random_{1};
};

// Nothing of it is aligned with anything.
Cell crooked_cell(Draws& draws) {
  Cell cell;
  cell.up_B = draws.vector(1.0).normalized();
  cell.X_BT = draws.pose();
  cell.X_FP = draws.pose();
  cell.X_FS = draws.pose();
  cell.payload_mass_kg = draws.uniform(0.3, 3.0);
  cell.payload_com_m = draws.vector(0.1);
  cell.robot.sensor.force_range_N = 300.0;
  cell.robot.sensor.torque_range_Nm = 300.0;
  return cell;
}

// What the sensor reads: a specific force on the payload, given in base axes, plus a bias. Written
// with matrices, frame by frame.
Vector6 reading(const Cell& cell, const Pose& X_TP, const Vector3& specific_B_mps2,
                const Vector6& bias) {
  const Eigen::Matrix3d R_BT = cell.X_BT.orientation.toRotationMatrix();
  const Eigen::Matrix3d R_FP = cell.X_FP.orientation.toRotationMatrix();
  const Eigen::Matrix3d R_FS = cell.X_FS.orientation.toRotationMatrix();
  const Eigen::Matrix3d R_BF = R_BT * X_TP.orientation.toRotationMatrix() * R_FP.transpose();
  const Vector3 force_S_N = cell.payload_mass_kg * (R_BF * R_FS).transpose() * specific_B_mps2;
  Vector6 raw = bias;
  raw.head<3>() += force_S_N;
  raw.tail<3>() += cell.payload_com_m.cross(force_S_N);
  return raw;
}

TEST(WrenchEstimatorOnATurningTool, WeightIsGoneInAnyPoseAfterOneTare) {
  Draws draws;
  double worst_N = 0.0;
  for (int i = 0; i < 20; ++i) {
    const Cell cell = crooked_cell(draws);
    const Vector3 gravity_B_mps2 = -kG_mps2 * cell.up_B;
    Vector6 bias;
    bias << draws.vector(20.0), draws.vector(2.0);
    WrenchEstimator estimator(cell);
    const Pose there = draws.pose();
    estimator.tare(reading(cell, there, gravity_B_mps2, bias), there);
    for (int pose = 0; pose < 100; ++pose) {
      const Pose here = draws.pose();
      ASSERT_EQ(estimator.update(reading(cell, here, gravity_B_mps2, bias), here),
                WrenchEstimator::Status::kGood);
      worst_N = std::max(worst_N, estimator.external().norm());
    }
  }
  EXPECT_LT(worst_N, 1e-9);
}

// Contact moves with the payload's frames: the same force and torque at the tip, in task axes, come
// back whatever the pose.
TEST(WrenchEstimatorOnATurningTool, AWrenchAtTheTipComesBackInTaskAxes) {
  Draws draws;
  for (int i = 0; i < 100; ++i) {
    const Cell cell = crooked_cell(draws);
    const Vector3 gravity_B_mps2 = -kG_mps2 * cell.up_B;
    WrenchEstimator estimator(cell);
    const Pose there = draws.pose();
    estimator.tare(reading(cell, there, gravity_B_mps2, Vector6::Zero()), there);
    const Pose here = draws.pose();
    const Vector3 force_T_N = draws.vector(30.0);
    const Vector3 torque_T_Nm = draws.vector(3.0);
    const Eigen::Matrix3d R_PS =
        cell.X_FP.orientation.toRotationMatrix().transpose() * cell.X_FS.orientation;
    const Eigen::Matrix3d R_ST = (here.orientation.toRotationMatrix() * R_PS).transpose();
    const Vector3 sensor_to_tip_S_m = cell.X_FS.orientation.toRotationMatrix().transpose() *
                                      (cell.X_FP.position_m - cell.X_FS.position_m);
    Vector6 raw = reading(cell, here, gravity_B_mps2, Vector6::Zero());
    raw.head<3>() += R_ST * force_T_N;
    raw.tail<3>() += R_ST * torque_T_Nm + sensor_to_tip_S_m.cross(Vector3(R_ST * force_T_N));
    ASSERT_EQ(estimator.update(raw, here), WrenchEstimator::Status::kGood);
    EXPECT_LT((estimator.external().head<3>() - force_T_N).norm(), 1e-9);
    EXPECT_LT((estimator.external().tail<3>() - torque_T_Nm).norm(), 1e-9);
  }
}

// The tool swings about a pivot at a constant rate; its payload feels the pull inwards, and the tip
// accelerates otherwise than the centre of mass.
//
// command of cycle k -> the arm moves from SYNC k + 1 to k + 2 -> sampled and told at k + 2
TEST(WrenchEstimatorOnATurningTool, TheInertiaOfASwingIsNoContact) {
  Cell cell;
  cell.X_FS.position_m = {0.0, 0.0, -0.05};
  cell.X_FP.position_m = {0.0, 0.0, -0.20};
  cell.payload_mass_kg = 2.0;
  cell.payload_com_m = {0.03, -0.04, -0.06};
  cell.robot.sensor.force_range_N = 300.0;
  cell.robot.sensor.torque_range_Nm = 30.0;
  cell.robot.measurement_delay_cycles = 1;
  constexpr double kT = 2e-3;
  const Vector3 omega(0.0, 2.5, 0.0);
  const Vector3 pivot(0.1, 0.2, 0.7);  // base and task coincide
  const auto tool_at = [&](double time_s) {
    const Eigen::Quaterniond turned = rotation_of(omega * time_s);
    return Pose{pivot + turned * Vector3(0.0, 0.0, -0.5), turned};
  };
  WrenchEstimator estimator(cell);
  estimator.tare(reading(cell, tool_at(0.0), {0.0, 0.0, -kG_mps2}, Vector6::Zero()), tool_at(0.0));
  double felt_N = 0.0;
  double felt_Nm = 0.0;
  double swing_N = 0.0;
  for (int cycle = 0; cycle < 400; ++cycle) {
    const Pose tool = tool_at(kT * cycle);
    const Vector3 com_m = tool.position_m + tool.orientation * Vector3(0.03, -0.04, 0.09);
    const Vector3 inwards_mps2 = omega.cross(omega.cross(Vector3(com_m - pivot)));
    const Vector6 raw =
        reading(cell, tool, Vector3(0.0, 0.0, -kG_mps2) - inwards_mps2, Vector6::Zero());
    ASSERT_EQ(estimator.update(raw, tool), WrenchEstimator::Status::kGood);
    if (cycle > 10) {
      felt_N = std::max(felt_N, estimator.external().head<3>().norm());
      felt_Nm = std::max(felt_Nm, estimator.external().tail<3>().norm());
      swing_N = std::max(swing_N, cell.payload_mass_kg * inwards_mps2.norm());
    }
    const Pose ahead = tool_at(kT * (cycle + 2));
    Vector6 velocity;
    velocity << omega.cross(Vector3(ahead.position_m - pivot)), omega;
    estimator.commanded(velocity);
  }
  EXPECT_GT(swing_N, 4.0);
  // What is left is the backward difference, half a cycle late: a share omega T / 2 of the swing.
  EXPECT_LT(felt_N, 0.03);
  EXPECT_LT(felt_Nm, 0.01);
}

}  // namespace
}  // namespace tenon::executor
