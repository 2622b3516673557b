#include "sim/physics/solver/contact_joints.h"

#include "sim/physics/contacts/contact_points.h"
#include "sim/physics/solver/contact_row.h"

namespace tenon::sim {
void ContactJoints::make(OdeWorld& world, const std::vector<dContactGeom>& points,
                         const ContactLaw& law, double step_s) {
  feedback_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ContactRow row = contact_row(law, share(points, i), i, step_s);
    dContact contact{};
    contact.geom = points[i];
    contact.surface.mode = dContactApprox1 | dContactSoftERP | dContactSoftCFM | dContactMotionN;
    contact.surface.mu = law.friction;
    contact.surface.soft_erp = row.correction;
    contact.surface.soft_cfm = row.softness;
    contact.surface.motionN = row.distinct_mps;
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
