#pragma once
// Contacts of a part that cannot rotate, without dWorldStep. Private to sim; one thread.

#include <ode/ode.h>

#include <vector>

#include "shared/math/pose.h"
#include "sim/physics/contacts/contact_law.h"

namespace tenon::sim {

/// Finds what dWorldStep finds, by its own rules (ODE manual, "Contact"; friction as
/// dContactApprox1): first the normal forces without friction, which bound the friction along two
/// directions, and then all rows together, each between its bounds. Where nothing rotates these
/// rows are few and hardly couple, so that a sweep over them and a few more settle what takes the
/// general solver ten times as long.
class LockedContacts {
 public:
  /// @param velocity_mps that the body would have after the step without any contact
  /// @param give_mpspN by how much a force along each of the world's axes changes that velocity; 0
  /// for an axis that is held
  /// @return false where the sweeps did not settle: the general solver's work
  [[nodiscard]] bool solve(const std::vector<dContactGeom>& points, const ContactLaw& law,
                           const Vector3& velocity_mps, const Vector3& give_mpspN, double step_s);

  /// Of the last solve(): force on the body and its torque about a point of the world, N and Nm.
  /// How faces share a friction that any of them could bear alone is open, and so is that part of
  /// the torque; nothing yields to it.
  [[nodiscard]] Vector6 wrench_about(const Vector3& point_m) const;

 private:
  struct Row {
    Vector3 way;
    Vector3 moved;           ///< velocity that a newton along the way adds
    double softness = 0.0;   ///< m/(Ns)
    double grip_Nspm = 0.0;  ///< force for a change of the velocity along the way
    double wanted_mps = 0.0;
    double least_N = 0.0;
    double most_N = 0.0;
    double force_N = 0.0;
  };
  static constexpr std::size_t kRowsAPoint = 3;  // normal, friction, friction

  void make_rows(const std::vector<dContactGeom>& points, const ContactLaw& law,
                 const Vector3& give_mpspN, double step_s);
  /// Every `stride`th row. @return whether they settled
  bool sweep(std::size_t stride, Vector3& velocity_mps);

  std::vector<Row> rows_;
  std::vector<Vector3> positions_m_;
};

}  // namespace tenon::sim
