#pragma once
// What efforts a serial arm's joints need for a motion: against gravity and the inertia of links
// and payload, as URDF and cell give them; friction and contacts are not its own. Newton and Euler,
// from the base to the tool and back (Luh, Walker, Paul 1980). Owns a copy of what it needs; no
// allocation, so fit for real time and for any thread.

#include <array>
#include <cstddef>

#include "shared/cell/cell.h"
#include "shared/ports/arm.h"

namespace tenon {

class InverseDynamics {
 public:
  /// The payload is a point in its centre of mass: no cell knows its moment of inertia.
  explicit InverseDynamics(const Cell& cell);

  /// @param position, velocity, acceleration of the joints, m and rad
  /// @return N or Nm, a joint each, in the joint's direction
  [[nodiscard]] JointVector effort(const JointVector& position, const JointVector& velocity,
                                   const JointVector& acceleration) const noexcept;

 private:
  struct Link {
    Pose origin;
    Vector3 axis = Vector3::UnitX();
    bool revolute = true;
    LinkInertia inertia;
  };
  /// A link as it moves, in base axes.
  struct Moving {
    Vector3 axis;
    Vector3 origin_m;
    Vector3 omega_radps;
    Vector3 alpha_radps2;
    Vector3 acceleration_mps2;  ///< of the origin
    Vector3 com_m;              ///< from the origin
    Vector3 force_N;            ///< that moves it
    Vector3 torque_Nm;          ///< the same, about its centre of mass
  };
  void move(const Link& link, double position, double velocity, double acceleration,
            Eigen::Matrix3d& orientation, Moving& moving) const noexcept;

  std::array<Link, kMaxJoints> links_{};
  std::size_t count_;
  Vector3 lift_mps2_;  ///< a base that rises with it feels what gravity does
};

}  // namespace tenon
