#pragma once
// How an arm moves that nothing touches, in joint coordinates: its links' places and velocities,
// what each joint moves, and a step under motors that pull at the joints. Private to sim; one
// thread, no allocation after construction. Units are the joints' (m, N; rad, Nm).
//
// Spatial vectors about the base's origin: composite rigid bodies for the inertia, recursive
// Newton-Euler for weight and what velocities do (Featherstone, Rigid Body Dynamics Algorithms,
// 2008, sections 5.3 and 6.2).

#include <array>
#include <span>
#include <vector>

#include "shared/cell/robot.h"
#include "shared/ports/arm.h"
#include "sim/cell/virtual_arm/joint_motor.h"
#include "sim/physics/solver/ode_world.h"

namespace tenon::sim {

class ArmDynamics {
 public:
  /// @param links one a joint, in the joints' frames: mass, centre, inertia about the centre
  ArmDynamics(const std::vector<Joint>& joints, const std::vector<LinkInertia>& links,
              const Vector3& gravity_mps2);

  /// Where the arm is and how it moves. @param positions, velocities one a joint
  void place(const JointVector& positions, const JointVector& velocities);

  /// What joint i moves as the arm stands, kg or kg m^2.
  [[nodiscard]] double inertia(std::size_t i) const {
    return inertia_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i));
  }
  /// Of the link behind joint i: at its centre of mass, in the joint's axes, in the base.
  [[nodiscard]] BodyState link(std::size_t i) const;

  /// The joints' velocities at the end of a step, no motor being bounded.
  [[nodiscard]] JointVector velocities_after(std::span<const JointMotor> motors,
                                             double step_s) const;

 private:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxJoints, kMaxJoints>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxJoints, 1>;

  struct Spatial {
    Vector3 angular = Vector3::Zero();
    Vector3 linear = Vector3::Zero();  ///< at the base's origin; of a force: its sum
  };
  struct Inertia {
    double mass_kg = 0.0;
    Vector3 moment_kgm = Vector3::Zero();
    Eigen::Matrix3d about_origin_kgm2 = Eigen::Matrix3d::Zero();

    void operator+=(const Inertia& other);
    [[nodiscard]] Spatial momentum(const Spatial& velocity) const;
  };
  struct Link {
    bool revolute;
    Vector3 axis;  ///< in the joint's frame
    Vector3 origin_m;
    Eigen::Matrix3d origin;
    LinkInertia mass;
    // As placed:
    Eigen::Matrix3d rotation;
    Vector3 com_m;
    Spatial motion;  ///< of a unit velocity of the joint
    Spatial velocity;
    Inertia inertia;
  };

  static Spatial cross_motion(const Spatial& velocity, const Spatial& motion);
  static Spatial cross_force(const Spatial& velocity, const Spatial& momentum);
  static double power(const Spatial& motion, const Spatial& force);

  void place_links(const JointVector& positions, const JointVector& velocities);
  void find_inertia();
  void find_load(const JointVector& velocities);

  std::vector<Link> links_;
  Vector3 gravity_mps2_;
  Matrix inertia_;  ///< of the arm, as the joints feel it
  Vector load_;     ///< of the joints, by weight and velocities
  Vector velocities_;
};

}  // namespace tenon::sim
