#pragma once
// One joint of the virtual arm, with its servo and its holding brake: an ODE slider or hinge with
// both in its motor row, and what is known of it where the arm moves in joint coordinates. Private
// to sim.
//
// The servo is an implicit spring and damper from the demand to the motor's side of the gear, with
// an integral part, never stronger than the drive's torque:
//   F = K (q_d - q_m) + D (q_d' - q') + I,   I' = (K / T_i) (q_d - q_m)
// q_d follows the drive's demand with a first-order lag; K is the joint's stiffness; D is critical
// for what the joint moves in the arm's present pose. q_m - q is the gear's play: nothing while the
// gear drives, anything up to half the backlash either way while it does not. The brake is dry
// friction that holds more than the servo can pull. Where the demand names an impedance, K and D
// are that one's, F_0 stands in the place of I, and there is no lag. Positions are absolute and do
// not wrap. Units are the joint's: m and N, or rad and Nm.

#include <ode/ode.h>

#include <optional>

#include "shared/cell/robot.h"
#include "sim/cell/devices/virtual_drive.h"
#include "sim/cell/virtual_arm/joint_motor.h"
#include "sim/physics/solver/ode_world.h"

namespace tenon::sim {

class ServoJoint {
 public:
  struct Parameters {
    double lag_s = 0.0;             ///< time constant of the lag behind the demand
    double integral_time_s = 0.02;  ///< T_i; 0: no integral part, the joint sags under load
    double backlash = 0.0;          ///< from one side of the play to the other
  };

  /// What brake and servo are to do by the end of the next step. Neither: the joint is free.
  struct Demand {
    bool brake = true;     ///< holds the joint, whatever the servo does
    bool powered = false;  ///< the servo follows position and velocity
    double position = 0.0;
    double velocity = 0.0;
    double effort_max = 0.0;  ///< what torque the servo has, N or Nm
    /// Of a servo whose master sets stiffness and damping; unset: the joint's own.
    std::optional<VirtualDrive::Impedance> impedance = std::nullopt;
  };

  struct State {
    double position = 0.0;  ///< of the link
    double encoder = 0.0;   ///< on the motor's side of the gear
    double velocity = 0.0;
    double effort = 0.0;  ///< of the servo; 0 while it is off or the brake holds
  };

  /// Joins two bodies as they stand. @param parent null for the base  @param anchor_m, axis (unit):
  /// in the world  @param position what the joint reads there
  ServoJoint(const OdeWorld& world, const Joint& joint, const Parameters& parameters, dBodyID link,
             dBodyID parent, const Vector3& anchor_m, const Vector3& axis, double position);
  ServoJoint(const ServoJoint&) = delete;
  ServoJoint& operator=(const ServoJoint&) = delete;

  [[nodiscard]] dBodyID link() const { return link_; }

  /// Before a step: what its motor is to do. @param inertia kg or kg m^2, what the joint moves
  void drive(const Demand& demand, double inertia, double step_s);
  [[nodiscard]] const JointMotor& motor() const { return motor_; }

  /// A step in joint coordinates ended so; the motor pulled as it was to, within its bounds.
  void moved(double position, double velocity);
  /// Whether the link is where no end stop acts.
  [[nodiscard]] bool clear_of_stops() const;

  /// The two bodies have been put where state() has them.
  void stand();
  /// Before a step of the world, and after it.
  void load();
  void read();
  [[nodiscard]] const State& state() const { return state_; }

 private:
  void follow(const Demand& demand, double inertia, double step_s);
  void yield(const Demand& demand, double step_s);
  [[nodiscard]] double raw_position() const;
  [[nodiscard]] Vector3 axis() const;      ///< in the world
  [[nodiscard]] Vector3 anchor_m() const;  ///< in the world; of a hinge
  /// That the joint gave in the last step, N or Nm.
  [[nodiscard]] double raw_effort() const;
  [[nodiscard]] double play_at(double servo_position) const;
  void set_stops();
  void set(int parameter, double value);
  void settle(double effort);

  dJointID joint_;
  dBodyID link_;
  dJointFeedback feedback_{};
  bool revolute_;
  double lower_;
  double upper_;
  double effort_max_;
  double stiffness_;
  Parameters parameters_;

  double offset_;                        ///< from what ODE reads to the position
  double raw_ = 0.0;                     ///< what ODE reads
  bool follows_ = false;                 ///< in the last step
  double integral_ = 0.0;                ///< I
  double followed_;                      ///< q_d for the end of the last step
  double play_ = 0.0;                    ///< q_m - q
  JointMotor motor_;                     ///< of the last step
  Vector3 step_axis_ = Vector3::Zero();  ///< of the last step, to read its effort
  Vector3 step_lever_m_ = Vector3::Zero();
  State state_;
};

}  // namespace tenon::sim
