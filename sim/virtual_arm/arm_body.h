#pragma once
// The articulated arm in ODE: moving links on prismatic joints, a servo and a holding brake at
// each, the payload behind the force/torque sensor, and the environment that it touches. Private to
// sim.
//
// A servo is an implicit spring and damper from the demand to the joint, with an integral part, and
// never stronger than the joint's effort_max:
//   F = K (q_d - q) + D (q_d' - q') + (K / T_i) integral(q_d - q)
// q_d follows the drive's demand with a first-order lag. K is the arm's physical stiffness, D is
// critical for the mass that the joint moves. The brake is dry friction that holds more than the
// servo can pull. One thread; units are the joints' (m, N).

#include <cstddef>
#include <string>
#include <vector>

#include "shared/cell/cell.h"
#include "shared/ports/arm.h"
#include "shared/task/task.h"
#include "sim/ode/ode_world.h"
#include "sim/ode/scene.h"

namespace tenon::sim {

class ArmBody {
 public:
  struct Parameters {
    JointVector start_m{};
    Pose X_BE;  ///< where the task frame of the environment really stands, in the base
    Surface surface;
    double servo_lag_s = 0.0;  ///< time constant of the servos' first-order lag behind the demand
  };

  /// What a joint's servo is to do by the end of the next step.
  struct JointDemand {
    bool brake = true;
    double position_m = 0.0;
    double velocity_mps = 0.0;
  };

  struct JointState {
    double position_m = 0.0;
    double velocity_mps = 0.0;
    double effort_N = 0.0;  ///< of the servo; 0 while the brake holds
  };

  /// @throws InputError for joints that are not prismatic
  ArmBody(const Cell& cell, const Task& task, const Parameters& parameters);

  /// @param demands one a joint
  void step(const std::vector<JointDemand>& demands, double step_s);

  [[nodiscard]] const JointState& joint(std::size_t i) const { return joints_[i].state; }
  /// What acts on the load beyond the sensor (contacts, weight, minus inertia), in the sensor's
  /// axes about its origin, over the last step.
  [[nodiscard]] const Vector6& wrench() const { return wrench_; }
  [[nodiscard]] Pose tool() const;  ///< in the base
  /// Sum of the environment's forces on the part in the last step.
  [[nodiscard]] double contact_force_N() const { return scene_.wrench().head<3>().norm(); }
  [[nodiscard]] std::vector<std::string> touching() const { return scene_.touching(); }
  /// Depth by which part and environment overlap as they stand.
  [[nodiscard]] double overlap_m() const { return scene_.overlap_m(); }
  /// Messages of the solver so far: steps that it did not solve.
  [[nodiscard]] std::uint64_t solver_messages() const { return solver_messages_; }

 private:
  struct ServoJoint {
    dBodyID link = nullptr;
    dJointID slider = nullptr;
    double effort_max_N = 0.0;
    double stiffness_Npm = 0.0;
    double damping_Nspm = 0.0;
    bool braked = true;
    double integral_N = 0.0;  ///< what the integral part pulls
    double followed_m = 0.0;  ///< q_d for the end of the last step
    double command_velocity_mps = 0.0;
    double softness = 0.0;  ///< CFM
    double force_max_N = 0.0;
    JointState state;
  };

  void build_links(const Cell& cell);
  void build_payload(const Cell& cell, const Pose& X_BF);
  void move_to(const JointVector& start_m);
  void drive(ServoJoint& joint, const JointDemand& demand, double step_s);
  void follow(ServoJoint& joint, const JointDemand& demand, double step_s);
  void read(ServoJoint& joint);
  void read_wrench();

  OdeWorld world_;
  Scene scene_;
  Surface surface_;
  double servo_lag_s_;
  std::vector<ServoJoint> joints_;
  dBodyID payload_ = nullptr;
  dJointID mount_ = nullptr;
  dJointFeedback mount_feedback_{};
  Pose X_LP_;  ///< tool in the payload body's frame (its centre of mass, sensor axes)
  Vector3 sensor_m_ = Vector3::Zero();  ///< sensor's origin in the payload body's frame
  Vector6 wrench_ = Vector6::Zero();
  std::uint64_t solver_messages_ = 0;
};

}  // namespace tenon::sim
