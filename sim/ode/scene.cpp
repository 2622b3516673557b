#include "sim/ode/scene.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace tenon::sim {
namespace {

// Tiny, distinct normal velocities keep dWorldStep's LCP away from the degenerate corners in which
// it gives up and lets parts through each other.
constexpr double kDistinctVelocity_mps = 1e-7;

dGeomID make_geom(const Shape& shape) {
  switch (shape.kind) {
    case Shape::Kind::kBox:
      return dCreateBox(nullptr, shape.size_m.x(), shape.size_m.y(), shape.size_m.z());
    case Shape::Kind::kCylinder:
      return dCreateCylinder(nullptr, 0.5 * shape.size_m.x(), shape.size_m.z());
  }
  assert(false);
  return nullptr;
}

bool boxes_overlap(dGeomID a, dGeomID b) {
  std::array<dReal, 6> box_a{};
  std::array<dReal, 6> box_b{};
  dGeomGetAABB(a, box_a.data());
  dGeomGetAABB(b, box_b.data());
  return box_a[0] <= box_b[1] && box_b[0] <= box_a[1] && box_a[2] <= box_b[3] &&
         box_b[2] <= box_a[3] && box_a[4] <= box_b[5] && box_b[4] <= box_a[5];
}

}  // namespace

Scene::Scene(const std::vector<Shape>& held, const std::vector<Shape>& environment,
             const Pose& X_WT)
    : feedback_(kPoints) {
  for (const Shape& shape : held) {
    held_names_.push_back(shape.name);
    held_offsets_.push_back(shape.pose);
    held_.push_back(make_geom(shape));
  }
  for (const Shape& shape : environment) {
    environment_names_.push_back(shape.name);
    environment_.push_back(make_geom(shape));
    set_pose(environment_.back(), compose(X_WT, shape.pose));
  }
}

Scene::~Scene() {
  for (const dGeomID geom : held_) dGeomDestroy(geom);
  for (const dGeomID geom : environment_) dGeomDestroy(geom);
}

void Scene::attach(dBodyID body, const Pose& X_BP) {
  for (std::size_t i = 0; i < held_.size(); ++i) {
    const Pose offset = compose(X_BP, held_offsets_[i]);
    const Eigen::Quaterniond& q = offset.orientation;
    const dQuaternion raw = {q.w(), q.x(), q.y(), q.z()};
    dGeomSetBody(held_[i], body);
    dGeomSetOffsetPosition(held_[i], offset.position_m.x(), offset.position_m.y(),
                           offset.position_m.z());
    dGeomSetOffsetQuaternion(held_[i], raw);
  }
}

Scene::Contacts Scene::collide(OdeWorld& world, double step_s, const Surface& surface) {
  Contacts result;
  points_ = 0;
  touching_.clear();
  std::array<dContact, kPointsAPair> contacts;
  for (std::size_t h = 0; h < held_.size(); ++h) {
    for (std::size_t e = 0; e < environment_.size(); ++e) {
      if (!boxes_overlap(held_[h], environment_[e])) continue;
      const int found =
          dCollide(held_[h], environment_[e], kPointsAPair, &contacts[0].geom, sizeof(dContact));
      if (found == 0) continue;
      touching_.push_back({h, e});
      // The pair's stiffness and damping, shared out; ODE's erp and cfm are an implicit spring.
      const double spring = step_s * surface.stiffness_Npm / found;
      const double damper = surface.relaxation_s * surface.stiffness_Npm / found;
      for (int i = 0; i < found && points_ < kPoints; ++i) {
        dContact& contact = contacts[static_cast<std::size_t>(i)];
        contact.surface = {};
        contact.surface.mode =
            dContactApprox1 | dContactSoftERP | dContactSoftCFM | dContactMotionN;
        contact.surface.mu = surface.friction;
        contact.surface.soft_erp = spring / (spring + damper);
        contact.surface.soft_cfm = 1.0 / (spring + damper);
        contact.surface.motionN = kDistinctVelocity_mps * static_cast<double>(points_ + 1);
        result.depth_max_m = std::max(result.depth_max_m, static_cast<double>(contact.geom.depth));
        const dJointID joint = dJointCreateContact(world.id(), world.contacts(), &contact);
        dJointAttach(joint, dGeomGetBody(held_[h]), nullptr);
        dJointSetFeedback(joint, &feedback_[points_]);
        ++points_;
      }
    }
  }
  result.points = points_;
  return result;
}

Vector6 Scene::wrench() const {
  Vector6 sum = Vector6::Zero();
  for (std::size_t i = 0; i < points_; ++i) {
    const dJointFeedback& f = feedback_[i];
    sum.head<3>() += Vector3(f.f1[0], f.f1[1], f.f1[2]);
    sum.tail<3>() += Vector3(f.t1[0], f.t1[1], f.t1[2]);
  }
  return sum;
}

double Scene::overlap_m() const {
  double deepest = 0.0;
  std::array<dContactGeom, kPointsAPair> contacts;
  for (const dGeomID held : held_) {
    for (const dGeomID environment : environment_) {
      if (!boxes_overlap(held, environment)) continue;
      const int found =
          dCollide(held, environment, kPointsAPair, contacts.data(), sizeof(dContactGeom));
      for (int i = 0; i < found; ++i) {
        deepest =
            std::max(deepest, static_cast<double>(contacts[static_cast<std::size_t>(i)].depth));
      }
    }
  }
  return deepest;
}

std::string Scene::name(const Pair& pair) const {
  return held_names_[pair.held] + "-" + environment_names_[pair.environment];
}

std::vector<std::string> Scene::touching() const {
  std::vector<std::string> names;
  for (const Pair& pair : touching_) names.push_back(name(pair));
  return names;
}

}  // namespace tenon::sim
