#include "sim/physics/solver/contact_joints.h"

#include "sim/physics/contacts/contact_points.h"

namespace tenon::sim {
namespace {

// Tiny, distinct normal velocities keep dWorldStep's LCP away from the degenerate corners in which
// it gives up and lets parts through each other.
constexpr double kDistinctVelocity_mps = 1e-7;

}  // namespace

void ContactJoints::make(OdeWorld& world, const std::vector<dContactGeom>& points,
                         const ContactLaw& law, double step_s) {
  const std::vector<double> share = shares(points);
  feedback_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    // A face's stiffness and damping, shared out; ODE's erp and cfm are an implicit spring.
    const double spring = step_s * law.stiffness_Npm * share[i];
    const double damper = law.relaxation_s * law.stiffness_Npm * share[i];
    dContact contact{};
    contact.geom = points[i];
    contact.surface.mode = dContactApprox1 | dContactSoftERP | dContactSoftCFM | dContactMotionN;
    contact.surface.mu = law.friction;
    contact.surface.soft_erp = spring / (spring + damper);
    contact.surface.soft_cfm = 1.0 / (spring + damper);
    contact.surface.motionN = kDistinctVelocity_mps * static_cast<double>(i + 1);
    const dJointID joint = dJointCreateContact(world.id(), world.contacts(), &contact);
    dJointAttach(joint, dGeomGetBody(contact.geom.g1), nullptr);
    dJointSetFeedback(joint, &feedback_[i]);
  }
}

Vector6 ContactJoints::wrench() const {
  Vector6 sum = Vector6::Zero();
  for (const dJointFeedback& f : feedback_) {
    sum.head<3>() += Vector3(f.f1[0], f.f1[1], f.f1[2]);
    sum.tail<3>() += Vector3(f.t1[0], f.t1[1], f.t1[2]);
  }
  return sum;
}

}  // namespace tenon::sim
