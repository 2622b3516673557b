#pragma once
// A free body that follows a setpoint through the compliance law. Private to sim.

#include <ode/ode.h>

#include <cstdint>
#include <optional>

#include "shared/motion/admittance.h"
#include "shared/motion/guarded_move.h"
#include "shared/motion/move_parameters.h"
#include "sim/physics/solver/ode_world.h"

namespace tenon::sim {

/// What an arm gives way by, in series with the compliance that it is commanded: its links, its
/// sensor and the fixture, as one spring with a damper between where its encoders see the tool and
/// where the part is. Along the axes that yield; 0 is rigid.
struct ArmGive {
  double give_mpN = 0.0;
  double relaxation_s = 2e-3;  ///< damping over stiffness
};

/// M (x'' - xs'') + D (x' - xs') + K (x - xs) = f for a tool that holds a part at its tip, and the
/// part behind an arm that gives way; in two ways that agree. Among contacts, tool and arm are
/// velocity constraints on the part's body with the right softness, which dWorldStep integrates
/// implicitly: stable for any stiffness and step. Where the force is known beforehand, in free
/// flight above all, the same implicit step has a closed form, the Admittance, at a tenth of the
/// time. Axes that do not yield follow the setpoint.
class CompliantTool {
 public:
  CompliantTool(OdeWorld& world, const Compliance& compliance);
  CompliantTool(const CompliantTool&) = delete;
  CompliantTool& operator=(const CompliantTool&) = delete;
  ~CompliantTool();

  /// What the coming moves are made with.
  /// @param turns whether anything can rotate the tool; else its orientation is held as it is, and
  /// the solver has no rotation to solve for
  void set_compliance(const Compliance& compliance, bool turns = true, const ArmGive& arm = {});
  /// At rest at a pose, and the part with it, as it stands under a force on it.
  void place(const Pose& pose, const Vector3& force_N = Vector3::Zero());
  /// Where the encoders see the tool.
  [[nodiscard]] const Pose& pose() const { return tool_.state().pose; }
  /// Where the part is that it holds.
  [[nodiscard]] Pose part_pose() const { return {pose().position_m + bent_m_, pose().orientation}; }
  /// The part's.
  [[nodiscard]] dBodyID body() const { return body_; }

  /// One step under a known force (world axes, about the body's origin). The body stays behind
  /// until it is needed.
  void fly(const GuardedMove::Setpoint& setpoint, double step_s,
           const Vector6& wrench = Vector6::Zero());
  /// All that a step changes.
  struct State {
    Admittance::State tool;
    Vector3 bent_m = Vector3::Zero();
  };
  [[nodiscard]] State state() const { return {tool_.state(), bent_m_}; }
  /// As it was; the body stays behind until it is needed.
  void return_to(const State& state);
  /// The translational velocity that fly() would leave the part with, and by how much a force along
  /// each axis would change it (m/s a N; 0 for an axis that does not yield).
  [[nodiscard]] Vector3 free_velocity_mps(const GuardedMove::Setpoint& setpoint,
                                          double step_s) const;
  [[nodiscard]] Vector3 give_mpspN(double step_s) const;
  /// Brings the body to where the part is, for collisions.
  void show();
  /// Sets the drive for the coming step of a shown body. Call before OdeWorld::step().
  /// @param torque_Nm that the tool yields to besides what contacts make, world axes
  void drive(const GuardedMove::Setpoint& setpoint, double step_s,
             const Vector3& torque_Nm = Vector3::Zero());
  /// Takes the tool to where the step has brought the body. Call after OdeWorld::step().
  void follow();

 private:
  void bend(const Vector3& force_N, double step_s);

  Compliance compliance_;
  ArmGive arm_;
  Admittance tool_;
  Vector3 bent_m_ = Vector3::Zero();  ///< of the part, from where the tool is
  bool turns_ = true;
  bool shown_ = false;                                   ///< the body is where the part is
  std::optional<Eigen::Quaterniond> shown_orientation_;  ///< the body's, where it is known
  /// What the body is driven with: of drive(), for follow().
  struct Drive {
    GuardedMove::Setpoint setpoint;
    double step_s = 0.0;
    Vector3 free_mps = Vector3::Zero();
    Vector3 give_mpspN = Vector3::Zero();
  };
  Drive drive_;
  dBodyID body_;
  dJointID translation_;
  dJointID rotation_;
};

}  // namespace tenon::sim
