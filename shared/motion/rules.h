#pragma once
// The inequalities that keep contact detection honest.

#include <optional>
#include <string>

#include "shared/motion/move_parameters.h"

namespace tenon {

/// What the thresholds have to cope with.
struct ContactConditions {
  double friction_max = 0.3;           ///< largest coefficient of friction
  int contacts_max = 2;                ///< contacts held at once while another is sought
  double mass_uncompensated_kg = 0.0;  ///< payload mass whose inertia the sensor still sees
  double force_noise_N = 0.0;          ///< standard deviation of one force sample
};

/// Empty where the thresholds hold: 0 < off < keep < on, 1.5 on <= force limit,
/// on >= 1.25 mu (n + mu n (n - 1) / 2) keep, on >= 2 m a_max, on >= 5 sigma. Otherwise one line
/// that names the broken inequality with its numbers.
///
/// The friction term is larger than n mu keep: in a corner, friction at one wall can hold the tool
/// against the other with mu keep more than the spring presses.
[[nodiscard]] std::optional<std::string> broken_rule(const ContactThresholds& thresholds,
                                                     double force_limit_N,
                                                     double acceleration_max_mps2,
                                                     const ContactConditions& conditions);

/// A lower threshold of force is within the noise of most sensors.
inline constexpr double kForceOnMin_N = 0.2;

/// "; is force_on_N in kN? then write 9 N", of a threshold below kForceOnMin_N that would be a
/// contact's in the larger unit; else nothing.
[[nodiscard]] std::string kilonewtons_hint(double force_on_N);

}  // namespace tenon
