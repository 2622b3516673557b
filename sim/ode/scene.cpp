#include "sim/ode/scene.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "sim/ode/contact_points.h"

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
             const Pose& X_WT) {
  for (const Shape& shape : held) {
    held_names_.push_back(shape.name);
    held_offsets_.push_back(shape.pose);
    held_sizes_m_.push_back(shape.size_m);
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

void Scene::set_oversize(double oversize_m) {
  if (oversize_m == oversize_m_) return;
  oversize_m_ = oversize_m;
  for (std::size_t i = 0; i < held_.size(); ++i) {
    const Vector3 size_m = held_sizes_m_[i] + Vector3::Constant(oversize_m);
    if (dGeomGetClass(held_[i]) == dBoxClass) {
      dGeomBoxSetLengths(held_[i], size_m.x(), size_m.y(), size_m.z());
    } else {
      dGeomCylinderSetParams(held_[i], 0.5 * size_m.x(), size_m.z());
    }
  }
}

Scene::Contacts Scene::collide(OdeWorld& world, double step_s, const Surface& surface) {
  Contacts result;
  points_.clear();
  touching_.clear();
  std::array<dContactGeom, kPointsAPair> found;
  for (std::size_t h = 0; h < held_.size(); ++h) {
    for (std::size_t e = 0; e < environment_.size(); ++e) {
      if (!boxes_overlap(held_[h], environment_[e])) continue;
      const int count =
          dCollide(held_[h], environment_[e], kPointsAPair, found.data(), sizeof(dContactGeom));
      if (count == 0) continue;
      touching_.push_back({h, e});
      points_.insert(points_.end(), found.begin(), found.begin() + count);
    }
  }
  for (const dContactGeom& point : points_) {
    result.depth_max_m = std::max(result.depth_max_m, static_cast<double>(point.depth));
  }
  thin_out(points_);
  result.points = points_.size();
  make_joints(world, step_s, surface);
  return result;
}

void Scene::make_joints(OdeWorld& world, double step_s, const Surface& surface) {
  const std::vector<double> share = shares(points_);
  feedback_.resize(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    // A face's stiffness and damping, shared out; ODE's erp and cfm are an implicit spring.
    const double spring = step_s * surface.stiffness_Npm * share[i];
    const double damper = surface.relaxation_s * surface.stiffness_Npm * share[i];
    dContact contact{};
    contact.geom = points_[i];
    contact.surface.mode = dContactApprox1 | dContactSoftERP | dContactSoftCFM | dContactMotionN;
    contact.surface.mu = surface.friction;
    contact.surface.soft_erp = spring / (spring + damper);
    contact.surface.soft_cfm = 1.0 / (spring + damper);
    contact.surface.motionN = kDistinctVelocity_mps * static_cast<double>(i + 1);
    const dJointID joint = dJointCreateContact(world.id(), world.contacts(), &contact);
    dJointAttach(joint, dGeomGetBody(contact.geom.g1), nullptr);
    dJointSetFeedback(joint, &feedback_[i]);
  }
}

Vector6 Scene::wrench() const {
  Vector6 sum = Vector6::Zero();
  for (const dJointFeedback& f : feedback_) {
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
