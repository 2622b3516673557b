#include "executor/identification/identify_payload.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "executor/sensing/wrench_estimator.h"
#include "shared/base/text.h"

namespace tenon::executor {
namespace {

constexpr std::size_t kPosesMin = 4;
constexpr double kNoTurn_rad = 0.01;
// Of the residual, for the tolerance of the bias; no less than the printed digits can tell.
constexpr double kTolerance = 5.0;
constexpr double kForceTolerance_N = 0.05;
constexpr double kTorqueTolerance_Nm = 0.005;

Eigen::Matrix3d cross_matrix(const Vector3& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

struct Fit {
  Eigen::VectorXd solution;
  Eigen::VectorXd deviation;
  double residual = 0.0;  ///< root mean square
};

// Least squares; the deviations follow from the residual.
Fit least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  Fit fit;
  fit.solution = A.colPivHouseholderQr().solve(b);
  const double squares = (A * fit.solution - b).squaredNorm();
  fit.residual = std::sqrt(squares / static_cast<double>(b.size()));
  const double variance = squares / static_cast<double>(b.size() - A.cols());
  fit.deviation = ((A.transpose() * A).inverse().diagonal() * variance).cwiseSqrt();
  return fit;
}

// How far gravity turns: its spread across the two directions in which it varies most, over g.
struct Turn {
  double most_rad = 0.0;
  double least_rad = 0.0;
};
Turn turn_of(const std::vector<RestReading>& readings) {
  const auto count = static_cast<double>(readings.size());
  Vector3 mean = Vector3::Zero();
  for (const RestReading& reading : readings) mean += reading.gravity_S_mps2 / count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const RestReading& reading : readings) {
    const Vector3 off = reading.gravity_S_mps2 - mean;
    spread += off * off.transpose() / count;
  }
  const Vector3 squares =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread, Eigen::EigenvaluesOnly).eigenvalues();
  const auto angle = [](double square) { return std::sqrt(std::max(0.0, square)) / kGravity_mps2; };
  return {angle(squares[2]), angle(squares[1])};
}

void solve_forces(const std::vector<RestReading>& readings, PayloadIdentification& payload) {
  const auto rows = static_cast<Eigen::Index>(3 * readings.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows, 4);
  Eigen::VectorXd b(rows);
  Eigen::Index row = 0;
  for (const RestReading& reading : readings) {
    A.block<3, 1>(row, 0) = reading.gravity_S_mps2;
    A.block<3, 3>(row, 1).setIdentity();
    b.segment<3>(row) = reading.wrench.head<3>();
    row += 3;
  }
  const Fit fit = least_squares(A, b);
  payload.mass_kg = fit.solution[0];
  payload.mass_deviation_kg = fit.deviation[0];
  payload.force_bias_N = fit.solution.tail<3>();
  payload.force_residual_N = fit.residual;
}

void solve_torques(const std::vector<RestReading>& readings, PayloadIdentification& payload) {
  const auto rows = static_cast<Eigen::Index>(3 * readings.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows, 6);
  Eigen::VectorXd b(rows);
  Eigen::Index row = 0;
  for (const RestReading& reading : readings) {
    A.block<3, 3>(row, 0) = -cross_matrix(reading.gravity_S_mps2);
    A.block<3, 3>(row, 3).setIdentity();
    b.segment<3>(row) = reading.wrench.tail<3>();
    row += 3;
  }
  const Fit fit = least_squares(A, b);
  payload.com_m = fit.solution.head<3>() / payload.mass_kg;
  payload.com_deviation_m = fit.deviation.head<3>().maxCoeff() / std::abs(payload.mass_kg);
  payload.torque_bias_Nm = fit.solution.tail<3>();
  payload.torque_residual_Nm = fit.residual;
}

std::string identified_text(const PayloadIdentification& p) {
  std::string text = format(
      "payload: mass %.4f kg (deviation %.4f), centre of mass %.4f %.4f %.4f m (deviation %.4f)\n",
      p.mass_kg, p.mass_deviation_kg, p.com_m.x(), p.com_m.y(), p.com_m.z(), p.com_deviation_m);
  text += format("sensor bias: %.2f %.2f %.2f N, %.3f %.3f %.3f Nm\n", p.force_bias_N.x(),
                 p.force_bias_N.y(), p.force_bias_N.z(), p.torque_bias_Nm.x(), p.torque_bias_Nm.y(),
                 p.torque_bias_Nm.z());
  text += format("residual: %.3f N, %.4f Nm\n", p.force_residual_N, p.torque_residual_Nm);
  text += "for the cell file:\n";
  text += format("payload: {mass_kg: %.4f, com_m: [%.4f, %.4f, %.4f]}\n", p.mass_kg, p.com_m.x(),
                 p.com_m.y(), p.com_m.z());
  text += format(
      "sensor_bias: {force_N: [%.2f, %.2f, %.2f], torque_Nm: [%.3f, %.3f, %.3f], "
      "force_tolerance_N: %.2f, torque_tolerance_Nm: %.3f}\n",
      p.force_bias_N.x(), p.force_bias_N.y(), p.force_bias_N.z(), p.torque_bias_Nm.x(),
      p.torque_bias_Nm.y(), p.torque_bias_Nm.z(),
      std::max(kForceTolerance_N, kTolerance * p.force_residual_N),
      std::max(kTorqueTolerance_Nm, kTolerance * p.torque_residual_Nm));
  return text;
}

}  // namespace

PayloadIdentification identify_payload(const std::vector<RestReading>& readings) {
  PayloadIdentification payload;
  for (const RestReading& reading : readings) {
    payload.apparent_mass_kg +=
        reading.wrench.head<3>().dot(reading.gravity_S_mps2) /
        (kGravity_mps2 * kGravity_mps2 * static_cast<double>(readings.size()));
  }
  if (readings.empty()) return payload;
  const Turn turn = turn_of(readings);
  payload.turn_rad = turn.least_rad;
  payload.status = turn.most_rad < kNoTurn_rad     ? PayloadIdentification::Status::kNotTurned
                   : turn.least_rad < kTurnMin_rad ? PayloadIdentification::Status::kTurnedTooLittle
                                                   : PayloadIdentification::Status::kIdentified;
  if (payload.status == PayloadIdentification::Status::kIdentified && readings.size() < kPosesMin) {
    payload.status = PayloadIdentification::Status::kTooFewPoses;
  }
  if (payload.status != PayloadIdentification::Status::kIdentified) return payload;
  solve_forces(readings, payload);
  solve_torques(readings, payload);
  return payload;
}

std::string describe(const PayloadIdentification& payload) {
  switch (payload.status) {
    case PayloadIdentification::Status::kIdentified:
      return identified_text(payload);
    case PayloadIdentification::Status::kTooFewPoses:
      return format("payload: not identified, needs readings in at least %d poses\n",
                    static_cast<int>(kPosesMin));
    case PayloadIdentification::Status::kNotTurned:
      return format(
          "payload: not identified: the robot does not turn its sensor, so only weight and bias "
          "together along gravity are seen, as %.3f kg; centre of mass and bias cannot be told\n",
          payload.apparent_mass_kg);
    case PayloadIdentification::Status::kTurnedTooLittle:
      return format(
          "payload: not identified: the poses turn gravity by %.3f rad about one of two axes, must "
          "be at least %g rad; start where the last joints have more room\n",
          payload.turn_rad, kTurnMin_rad);
  }
  return "?";
}

const char* to_string(PayloadIdentification::Status status) {
  switch (status) {
    case PayloadIdentification::Status::kIdentified:
      return "identified";
    case PayloadIdentification::Status::kTooFewPoses:
      return "too_few_poses";
    case PayloadIdentification::Status::kNotTurned:
      return "not_turned";
    case PayloadIdentification::Status::kTurnedTooLittle:
      return "turned_too_little";
  }
  return "?";
}

Finding finding_of(const PayloadIdentification& p) {
  const bool found = p.status == PayloadIdentification::Status::kIdentified;
  Finding finding{found, to_string(p.status), describe(p), {}};
  if (!found) return finding;
  const auto three = [](const Vector3& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
  finding.values = {{"mass_kg", {p.mass_kg}},
                    {"mass_deviation_kg", {p.mass_deviation_kg}},
                    {"com_m", three(p.com_m)},
                    {"com_deviation_m", {p.com_deviation_m}},
                    {"force_bias_N", three(p.force_bias_N)},
                    {"torque_bias_Nm", three(p.torque_bias_Nm)},
                    {"force_residual_N", {p.force_residual_N}},
                    {"torque_residual_Nm", {p.torque_residual_Nm}}};
  return finding;
}

}  // namespace tenon::executor
