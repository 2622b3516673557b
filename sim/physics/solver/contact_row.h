#pragma once
// A contact law as the numbers that a row of the solver takes. Private to sim; pure.

#include <cstddef>

#include "sim/physics/contacts/contact_law.h"

namespace tenon::sim {

/// Tiny, distinct normal velocities keep dWorldStep's LCP away from the degenerate corners in which
/// it gives up and lets parts through each other.
inline constexpr double kDistinctVelocity_mps = 1e-7;
/// Of every row that has none of its own (the world's CFM), m/(Ns).
inline constexpr double kFrictionSoftness = 1e-9;

/// The normal's row of a contact point: a spring and a damper, implicit in the step.
struct ContactRow {
  double correction = 0.0;    ///< ERP: part of the depth that a step is to take away
  double softness = 0.0;      ///< CFM, m/(Ns)
  double distinct_mps = 0.0;  ///< motionN

  /// The velocity along the normal that the row asks for.
  [[nodiscard]] double approach_mps(double depth_m, double step_s) const {
    return correction * depth_m / step_s + distinct_mps;
  }
};

/// @param share of the face's stiffness that the point bears  @param index among the contact points
[[nodiscard]] inline ContactRow contact_row(const ContactLaw& law, double share, std::size_t index,
                                            double step_s) {
  const double spring_Nspm = step_s * law.stiffness_Npm * share;
  const double damper_Nspm = law.relaxation_s * law.stiffness_Npm * share;
  return {spring_Nspm / (spring_Nspm + damper_Nspm), 1.0 / (spring_Nspm + damper_Nspm),
          kDistinctVelocity_mps * static_cast<double>(index + 1)};
}

}  // namespace tenon::sim
