#pragma once
// Mass, centre of mass and sensor bias from readings of a resting payload in several poses. Pure
// mathematics: with the specific gravity g in sensor axes, a reading at rest is
//   force = m g + b_F,  torque = c x (m g) + b_T,
// linear in m, m c, b_F and b_T, so least squares solves it. Set-up code; allocates.

#include <cstdint>
#include <string>
#include <vector>

#include "executor/identification/finding.h"
#include "shared/cell/cell.h"
#include "shared/math/pose.h"

namespace tenon::executor {

/// The mean reading in one pose.
struct RestReading {
  Vector3 gravity_S_mps2 = Vector3::Zero();  ///< in sensor axes, pointing down
  Vector6 wrench = Vector6::Zero();          ///< raw, sensor axes, N and Nm
};

struct PayloadIdentification {
  enum class Status : std::uint8_t {
    kIdentified = 0,
    kTooFewPoses = 1,     ///< fewer than four
    kNotTurned = 2,       ///< gravity has the same direction in all poses: a gantry
    kTurnedTooLittle = 3  ///< about one axis only, or by less than kTurnMin_rad
  };
  Status status = Status::kTooFewPoses;
  double mass_kg = 0.0;
  Vector3 com_m = Vector3::Zero();         ///< in the sensor frame
  Vector3 force_bias_N = Vector3::Zero();  ///< sensor axes
  Vector3 torque_bias_Nm = Vector3::Zero();
  double mass_deviation_kg = 0.0;  ///< standard deviation, from the residual
  double com_deviation_m = 0.0;    ///< the largest of the three
  double force_residual_N = 0.0;   ///< root mean square a component
  double torque_residual_Nm = 0.0;
  double turn_rad = 0.0;  ///< root mean square turn about the least turned axis
  /// Where nothing turned: force along gravity over g. It still contains the bias.
  double apparent_mass_kg = 0.0;
};

/// Poses must turn gravity about two axes by at least this, root mean square.
inline constexpr double kTurnMin_rad = 0.1;

[[nodiscard]] PayloadIdentification identify_payload(const std::vector<RestReading>& readings);

[[nodiscard]] const char* to_string(PayloadIdentification::Status status);

/// Lines for people: values with deviations and residuals, then what the cell file should say. Or
/// what cannot be told, and why.
[[nodiscard]] std::string describe(const PayloadIdentification& payload);

[[nodiscard]] Finding finding_of(const PayloadIdentification& payload);

}  // namespace tenon::executor
