#pragma once
// Everything that decides how a guarded move runs and when it ends. The plan file carries these.

#include <cstdint>
#include <optional>

#include "shared/math/pose.h"
#include "shared/motion/contact_signature.h"

namespace tenon {

/// M (x'' - xs'') + D (x' - xs') + K (x - xs) = f, the same for every compliant translation, and
/// the same law for every compliant rotation about the tool tip.
struct Compliance {
  double mass_kg = 2.0;
  double damping_Nspm = 1500.0;
  double stiffness_Npm = 1000.0;
  double inertia_kgm2 = 0.02;
  double damping_Nmspr = 2.0;
  double stiffness_Nmpr = 20.0;
  /// Bit a (0..5: x y z rx ry rz): the axis yields. The others follow the setpoint rigidly, feel
  /// nothing, and carry no contact bits.
  std::uint8_t compliant_axes = 0x3F;

  friend bool operator==(const Compliance&, const Compliance&) = default;
};

/// Hysteresis of the contact bits, forces and torques apart: off < keep < on.
struct ContactThresholds {
  double force_on_N = 6.0;
  double force_keep_N = 3.0;
  double force_off_N = 1.5;
  double torque_on_Nm = 0.6;
  double torque_keep_Nm = 0.3;
  /// Also the least that turns a tool for good which presses against something.
  double torque_off_Nm = 0.15;
  /// A bit changes after fresh samples have agreed for this long.
  std::uint32_t debounce_us = 6000;

  friend bool operator==(const ContactThresholds&, const ContactThresholds&) = default;
};

/// While a bit is being confirmed the tool presses with this multiple of the on-threshold: a real
/// contact answers with that force whatever the impact left, and nothing else does.
inline constexpr double kProbeOverOn = 1.5;

/// A press whose line of action passes the tool tip this near is taken for one through it.
inline constexpr double kPressLever_m = 1e-3;

/// Torque thresholds for tools that are turned by what they press against and whose sensor nobody
/// knows: off is the press of a probe at kPressLever_m, keep twice and on four times that.
[[nodiscard]] constexpr ContactThresholds with_press_torques(ContactThresholds thresholds) {
  thresholds.torque_off_Nm = kProbeOverOn * thresholds.force_on_N * kPressLever_m;
  thresholds.torque_keep_Nm = 2.0 * thresholds.torque_off_Nm;
  thresholds.torque_on_Nm = 4.0 * thresholds.torque_off_Nm;
  return thresholds;
}

/// Limits of the command along the straight path of a move.
struct SpeedLimits {
  double approach_mps = 0.10;
  double contact_mps = 0.05;
  double acceleration_mps2 = 1.0;
  double jerk_mps3 = 20.0;
  double approach_radps = 0.5;
  double contact_radps = 0.2;
  double acceleration_radps2 = 5.0;
  double jerk_radps3 = 100.0;

  friend bool operator==(const SpeedLimits&, const SpeedLimits&) = default;
};

/// One guarded move. Displacement, contacts and travel are in the move's axes at the tool tip:
/// those of the task frame, or those that have turned with the tool.
struct MoveParameters {
  Vector6 displacement = Vector6::Zero();
  /// Distance from the start at which the command is down to contact speed, m of translation (rad
  /// where the displacement has no translation). 0: contact speed all the way.
  double slow_from_m = 0.0;
  SpeedLimits speeds;
  ContactThresholds thresholds;
  Compliance compliance;
  /// Where the tool is held, spring and feed-forward together pull no harder than this on any axis.
  double force_limit_N = 20.0;
  double torque_limit_Nm = 2.0;
  std::uint32_t timeout_us = 10'000'000;
  /// Only changes of these bits end the move.
  ContactSignature trigger_mask = kAllContacts;
  /// Bit a: the contact bits of this axis are decided from the wrench. Along the others something
  /// may push, below what the sensor resolves; nothing is concluded from it.
  std::uint8_t sensed_axes = 0x3F;
  /// Where rotations yield: a contact that ends the move is pressed until the tool lies flat on
  /// what it met. Otherwise it is held as it was met, and the tool turns no farther than its spring
  /// gives.
  bool aligns = true;
  /// Set: the move's axes have turned with the tool as far as it is turned away from this
  /// orientation as the move begins. A tool that has aligned with a face so moves along that face.
  std::optional<Eigen::Quaterniond> carried_from;
};

}  // namespace tenon
