#pragma once
// What a servo's motor and gear take of its effort before any of it reaches the joint. A position
// servo overcomes it, so the arm moves as without; the effort that the drive reports contains it:
//   f = c z(s) + b q' + h z(w),   dz(l) = (sign(dq) - z) |dq| / l
// z goes to the direction of the motion within its way l and stays where the joint rests: the short
// way s is the bristles' that make Coulomb friction, the long one w the gear's, whose lag behind
// every reversal is hysteresis. Units are the joint's: N and m, or Nm and rad. One thread.

#include "shared/cell/robot.h"

namespace tenon::sim {

/// Of one drive, as drawn. Shares of its rated effort.
struct DriveFriction {
  double coulomb_share = 0.0;
  double viscous_share = 0.0;  ///< at the joint's full speed
  double hysteresis_share = 0.0;
  double way_factor = 1.0;  ///< of the usual ways of bristles and gear
  double start = 0.0;       ///< z at power-on, -1 to 1: nobody knows how it came to rest

  friend bool operator==(const DriveFriction&, const DriveFriction&) = default;
};

class FrictionState {
 public:
  FrictionState() = default;
  /// @param position of the joint
  FrictionState(const Joint& joint, const DriveFriction& drawn, double position);

  /// The joint has come to this position, at this velocity.
  void update(double position, double velocity);
  /// N or Nm, in the joint's direction: what the drive's effort is more than the joint's.
  [[nodiscard]] double effort() const;

  /// Usual ways: of bristles, and of a gear. A revolute joint's in rad, a prismatic one's in m.
  static constexpr double kBristles_m = 3e-5;
  static constexpr double kBristles_rad = 2e-4;
  static constexpr double kGear_m = 5e-3;
  static constexpr double kGear_rad = 2e-2;

 private:
  double coulomb_ = 0.0;
  double viscous_ = 0.0;
  double hysteresis_ = 0.0;
  double bristles_ = kBristles_m;
  double gear_ = kGear_m;
  double position_ = 0.0;
  double velocity_ = 0.0;
  double z_bristles_ = 0.0;
  double z_gear_ = 0.0;
};

}  // namespace tenon::sim
