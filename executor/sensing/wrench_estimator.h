#pragma once
// From the raw reading of a wrist sensor to the external wrench that guarded moves live on: tared,
// without the payload's weight and inertia, moved to the tool tip, in task axes. The sensor is said
// to read what acts on the load beyond it: contact + m (g - a) + bias, with a that of the centre of
// mass as the tool turns. The payload's own moment of inertia is left out: no cell knows it. Its
// torque, I alpha, is 0.01 Nm for 1 kg within 6 cm at 3 rad/s^2. Real-time, one thread, no
// allocation.

#include <cstdint>

#include "executor/sensing/payload_motion.h"
#include "shared/cell/cell.h"
#include "shared/math/pose.h"

namespace tenon::executor {

/// Standard gravity.
inline constexpr double kGravity_mps2 = 9.80665;

class WrenchEstimator {
 public:
  enum class Status : std::uint8_t {
    kGood = 0,
    kSaturated = 1,  ///< an axis at its range; see axis()
    kNotFinite = 2,
  };

  /// @param delay_cycles clipped to what PayloadMotion remembers
  explicit WrenchEstimator(const Cell& cell);

  /// One fresh raw sample, in sensor axes. @param X_TP measured tool pose
  [[nodiscard]] Status update(const Vector6& raw, const Pose& X_TP);
  /// Once a cycle, fresh sample or not: velocity commanded to the tool in task axes.
  void commanded(const Vector6& velocity) { motion_.command(velocity); }

  /// Sets the bias so that the mean raw reading at rest at this pose means no contact.
  void tare(const Vector6& mean_raw, const Pose& X_TP);

  /// Moves the bias, in sensor axes: what has been read there means no contact from now on.
  void move_zero(const Vector6& by) { bias_ += by; }
  /// What the sensor reads, N and Nm, as a wrench at the tool tip in task axes.
  [[nodiscard]] Vector6 at_tool(const Vector6& at_sensor, const Pose& X_TP) const;

  /// What the sensor reads of itself, by the last tare; its axes, N and Nm.
  [[nodiscard]] const Vector6& bias() const { return bias_; }
  /// What the sensor reads while nothing touches, its axes, N: itself and the payload, as of the
  /// last good sample or the tare.
  [[nodiscard]] Vector3 unloaded_N() const { return unloaded_.head<3>(); }
  /// Of the last good sample: what the environment does to the tool, N and Nm.
  [[nodiscard]] const Vector6& external() const { return external_; }
  /// The same as the sensor reads it: its axes, about its origin.
  [[nodiscard]] const Vector6& contact() const { return contact_; }
  /// The axis that saturated.
  [[nodiscard]] int axis() const { return axis_; }

 private:
  // Wrench that weight and inertia put on the sensor, for a specific force in sensor axes.
  [[nodiscard]] Vector6 payload_wrench(const Vector3& specific_force_mps2) const;
  // Of the payload's centre of mass, task axes. @param to_com_T from the tip to it
  [[nodiscard]] Vector3 com_acceleration_mps2(const Vector3& to_com_T) const;
  [[nodiscard]] Eigen::Quaterniond R_TS(const Pose& X_TP) const;

  Vector3 gravity_T_mps2_;
  Pose X_SP_;
  double mass_kg_;
  Vector3 com_S_m_;
  double force_range_N_;
  double torque_range_Nm_;
  PayloadMotion motion_;
  Vector6 bias_ = Vector6::Zero();
  Vector6 unloaded_ = Vector6::Zero();
  Vector6 contact_ = Vector6::Zero();
  Vector6 external_ = Vector6::Zero();
  int axis_ = 0;
};

}  // namespace tenon::executor
