#pragma once
// The articulated arm: a body for each link, joined by sliders and hinges with a servo and a brake
// each, the payload behind the force/torque sensor, and the environment that it touches. It moves
// in joint coordinates while nothing is at a bound of its own, and as ODE's bodies where something
// touches it, a servo or a brake pulls with all it has, a joint is at its stop or nothing holds it.
// Private to sim. The payload's mass is rigid with the last link, the part's surface behind what
// the contact stiffness leaves the arm to give way by; the sensor's wrench follows from the
// momentum of what is beyond it. One thread; units are the joints' (m, N; rad, Nm).

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "shared/cell/cell.h"
#include "shared/ports/arm.h"
#include "shared/task/task.h"
#include "sim/cell/virtual_arm/arm_dynamics.h"
#include "sim/cell/virtual_arm/held_part.h"
#include "sim/cell/virtual_arm/servo_joint.h"
#include "sim/physics/contacts/contact_law.h"
#include "sim/physics/scene.h"
#include "sim/physics/solver/ode_world.h"

namespace tenon::sim {

class ArmBody {
 public:
  struct Parameters {
    JointVector start{};
    Pose X_BE;               ///< where the task frame of the environment really stands, in the base
    ContactLaw contact_law;  ///< its stiffness: of parts and arm in series
    double servo_lag_s = 0.0;
    double integral_time_s = 0.02;  ///< of the servos; 0: none
    double backlash_m = 0.0;        ///< of every prismatic joint
    double backlash_rad = 0.0;      ///< of every revolute joint
  };

  /// @throws InputError for a link whose mass or inertia no body can have
  ArmBody(const Cell& cell, const Task& task, const Parameters& parameters);

  /// @param demands one a joint
  void step(std::span<const ServoJoint::Demand> demands, double step_s);

  [[nodiscard]] std::size_t joint_count() const { return joints_.size(); }
  [[nodiscard]] const ServoJoint::State& joint(std::size_t i) const { return joints_[i].state(); }

  /// What acts on the load beyond the sensor (contacts, weight, minus inertia), in the sensor's
  /// axes about its origin, over the last step.
  [[nodiscard]] const Vector6& wrench() const { return wrench_; }
  [[nodiscard]] Pose tool() const;  ///< where the part is, in the base
  /// Kinetic and potential, of links and payload; its zero is arbitrary.
  [[nodiscard]] double energy_J() const;
  /// Sum of the environment's forces on the part in the last step.
  [[nodiscard]] double contact_force_N() const { return scene_.wrench().head<3>().norm(); }
  /// Part and environment, and what touched in the last step.
  [[nodiscard]] const Scene& scene() const { return scene_; }
  /// Deepest overlap of the part and the environment as they stand, m.
  [[nodiscard]] double overlap_m() { return scene_.overlap_m(); }
  /// Messages of the solver so far: steps that it did not solve.
  [[nodiscard]] std::uint64_t solver_messages() const { return solver_messages_; }

 private:
  void build(const Cell& cell, const Parameters& parameters);
  [[nodiscard]] dBodyID make_body(const Pose& X_BL, const LinkInertia& link);
  [[nodiscard]] LinkInertia with_payload(const Cell& cell, const LinkInertia& link);
  /// A step in joint coordinates. @return false: not taken, since a servo or a brake is at its
  /// bound in it, a joint at its stop, or one without either, which ODE lets fall at less error
  [[nodiscard]] bool move_freely(double step_s);
  void move_bodies(bool touched, double step_s);
  void place();
  void read_wrench(double step_s);
  [[nodiscard]] Vector6 load_momentum() const;
  [[nodiscard]] BodyState last_link() const { return dynamics_->link(joints_.size() - 1); }

  OdeWorld world_;
  Scene scene_;
  ContactLaw contact_law_;
  Vector3 gravity_mps2_;
  std::vector<LinkInertia> links_;  ///< in the joints' frames, the last one's with the payload
  std::deque<ServoJoint> joints_;
  std::optional<ArmDynamics> dynamics_;
  std::vector<JointMotor> motors_;
  std::optional<HeldPart> part_;
  LinkInertia load_;                    ///< beyond the sensor, in the last body's frame
  Pose X_OP_;                           ///< tool in the last body's frame
  Pose X_OS_;                           ///< sensor in the last body's frame
  Vector6 momentum_ = Vector6::Zero();  ///< of the load: linear, angular about its centre of mass
  Vector6 wrench_ = Vector6::Zero();
  bool bodies_stand_ = true;  ///< where the joints have them
  std::uint64_t solver_messages_ = 0;
};

}  // namespace tenon::sim
