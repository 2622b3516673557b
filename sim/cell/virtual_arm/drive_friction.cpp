#include "sim/cell/virtual_arm/drive_friction.h"

#include <cmath>

namespace tenon::sim {
namespace {

/// The exact solution for a motion in one direction.
double followed(double z, double moved, double way) {
  if (moved == 0.0) return z;
  const double direction = moved > 0.0 ? 1.0 : -1.0;
  return direction + (z - direction) * std::exp(-std::abs(moved) / way);
}

}  // namespace

FrictionState::FrictionState(const Joint& joint, const DriveFriction& drawn, double position)
    : coulomb_(drawn.coulomb_share * joint.rated_effort),
      viscous_(joint.speed_max > 0.0 ? drawn.viscous_share * joint.rated_effort / joint.speed_max
                                     : 0.0),
      hysteresis_(drawn.hysteresis_share * joint.rated_effort),
      position_(position),
      z_bristles_(drawn.start),
      z_gear_(drawn.start) {
  const bool revolute = joint.kind == Joint::Kind::kRevolute;
  bristles_ = drawn.way_factor * (revolute ? kBristles_rad : kBristles_m);
  gear_ = drawn.way_factor * (revolute ? kGear_rad : kGear_m);
}

void FrictionState::update(double position, double velocity) {
  const double moved = position - position_;
  position_ = position;
  velocity_ = velocity;
  z_bristles_ = followed(z_bristles_, moved, bristles_);
  z_gear_ = followed(z_gear_, moved, gear_);
}

double FrictionState::effort() const {
  return coulomb_ * z_bristles_ + viscous_ * velocity_ + hysteresis_ * z_gear_;
}

}  // namespace tenon::sim
