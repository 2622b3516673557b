#include "sim/cell/virtual_arm/held_part.h"

namespace tenon::sim {
namespace {

// The payload's mass is the link's: this one only has to be so little that stopping it from contact
// speed within a step takes no force that a sensor would tell from noise.
constexpr double kMass_kg = 1e-3;
constexpr double kRadius_m = 0.05;
constexpr double kRelaxation_s = 2e-3;  // damping over stiffness, as between parts

}  // namespace

HeldPart::HeldPart(const OdeWorld& world, dBodyID link, double give_mpN)
    : link_(link),
      body_(dBodyCreate(world.id())),
      joint_(dJointCreateFixed(world.id(), nullptr)),
      give_mpN_(give_mpN) {
  dMass mass;
  dMassSetSphereTotal(&mass, kMass_kg, kRadius_m);
  dBodySetMass(body_, &mass);
  dBodySetGravityMode(body_, 0);
  set_pose(body_, pose_of(link));
  dJointAttach(joint_, link, body_);
  dJointSetFixed(joint_);
}

Vector3 HeldPart::bent_m() const {
  return vector_of(dBodyGetPosition(body_)) - vector_of(dBodyGetPosition(link_));
}

void HeldPart::prepare(double step_s) {
  dJointSetFixedParam(joint_, dParamERP, step_s / (step_s + kRelaxation_s));
  dJointSetFixedParam(joint_, dParamCFM, give_mpN_ / (step_s + kRelaxation_s));
}

}  // namespace tenon::sim
