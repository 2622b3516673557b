#pragma once
// Contacts of a part that cannot rotate, without dWorldStep. Private to sim; one thread.

#include <ode/ode.h>

#include <utility>
#include <vector>

#include "shared/math/pose.h"
#include "sim/physics/contacts/contact_law.h"

namespace tenon::sim {

/// Finds what dWorldStep finds, by its own rules (ODE manual, "Contact"; friction as
/// dContactApprox1): first the normal forces without friction, which bound the friction along two
/// directions, and then all rows together, each between its bounds. Where nothing rotates, all that
/// is unknown is a velocity in three directions, and each row's force follows from it, linearly
/// between its bounds: so a few of Newton's steps on what is then a convex function find the one
/// velocity at which all forces balance, in a tenth of the general solver's time.
class LockedContacts {
 public:
  /// @param velocity_mps that the body would have after the step without any contact
  /// @param give_mpspN by how much a force along each of the world's axes changes that velocity; 0
  /// for an axis that is held
  /// @return false where it did not settle: the general solver's work
  [[nodiscard]] bool solve(const std::vector<dContactGeom>& points, const ContactLaw& law,
                           const Vector3& velocity_mps, const Vector3& give_mpspN, double step_s);

  /// Of the last solve(): force on the body and its torque about a point of the world, N and Nm.
  /// How faces share a friction that any of them could bear alone is open, and so is that part of
  /// the torque; nothing yields to it.
  [[nodiscard]] Vector6 wrench_about(const Vector3& point_m) const;

 private:
  struct Row {
    Vector3 way;
    double softness = 0.0;      ///< m/(Ns)
    double damping_Nspm = 0.0;  ///< its inverse
    double wanted_mps = 0.0;
    double least_N = 0.0;
    double most_N = 0.0;
    double force_N = 0.0;
    int bound = 0;  ///< -1 or +1: the force is at its lower or upper bound

    void be_soft(double by) {
      softness = by;
      damping_Nspm = 1.0 / by;
    }
  };
  static constexpr std::size_t kRowsAPoint = 3;  // normal, friction, friction

  /// Without any contact.
  struct Tool {
    Vector3 velocity_mps;
    Vector3 damping_Nspm;  ///< what resists a change of it; 0 for an axis that is held
  };
  /// At some velocity: what is missing to balance, the gradient of the convex function, and how it
  /// changes with the velocity.
  struct Pull {
    Vector3 force_N;
    Eigen::Matrix3d slope_Nspm;
    bool same_bounds;  ///< every force is where it was before, between its bounds or at one of them
  };

  void make_rows(const std::vector<dContactGeom>& points, const ContactLaw& law, double step_s);
  /// Of every `stride`th row, whose forces it sets.
  [[nodiscard]] Pull pull_at(const Vector3& velocity_mps, const Tool& tool, std::size_t stride);
  /// Where that function is least along a way, in parts of it. @param slope_W at its beginning
  [[nodiscard]] double lowest_along(const Vector3& velocity_mps, const Vector3& way_mps,
                                    const Tool& tool, double slope_W, std::size_t stride);
  /// @param velocity_mps where to begin; where all balances  @return whether it was found
  [[nodiscard]] bool settle(const Tool& tool, std::size_t stride, Vector3& velocity_mps);

  std::vector<Row> rows_;
  std::vector<std::pair<double, double>> bends_;
  std::vector<Vector3> positions_m_;
};

}  // namespace tenon::sim
