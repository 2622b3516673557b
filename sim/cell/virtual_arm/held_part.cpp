#include "sim/cell/virtual_arm/held_part.h"

namespace tenon::sim {
namespace {

// The payload's mass is the link's: this one only has to be so little that stopping it from contact
// speed within a step takes no force that a sensor would tell from noise.
constexpr double kMass_kg = 1e-3;
constexpr double kRadius_m = 0.05;
constexpr double kRelaxation_s = 2e-3;  // damping over stiffness, as between parts
// Nearer to where the link has it, it is there: a force of 0.01 N, its weight, bends most arms by
// more.
constexpr double kThere_m = 1e-7;

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

bool HeldPart::there() const { return bent_m_.norm() < kThere_m; }

void HeldPart::ride(const BodyState& link) {
  bent_m_.setZero();
  set_state(body_, link);
}

void HeldPart::load(double step_s, bool touched) {
  const bool rides = !touched && there();
  if (rides != rides_) {
    rides ? dBodyDisable(body_) : dBodyEnable(body_);
    rides ? dJointDisable(joint_) : dJointEnable(joint_);
    rides_ = rides;
  }
  dJointSetFixedParam(joint_, dParamERP, step_s / (step_s + kRelaxation_s));
  dJointSetFixedParam(joint_, dParamCFM, give_mpN_ / (step_s + kRelaxation_s));
}

void HeldPart::look() {
  if (rides_) return ride(state_of(link_));
  bent_m_ = vector_of(dBodyGetPosition(body_)) - vector_of(dBodyGetPosition(link_));
}

}  // namespace tenon::sim
