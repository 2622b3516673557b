#include "sim/cell/virtual_arm/arm_dynamics.h"

#include <Eigen/Cholesky>

namespace tenon::sim {

ArmDynamics::ArmDynamics(const std::vector<Joint>& joints, const std::vector<LinkInertia>& links,
                         const Vector3& gravity_mps2)
    : gravity_mps2_(gravity_mps2) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    Link link{};
    link.revolute = joints[i].kind == Joint::Kind::kRevolute;
    link.axis = joints[i].axis;
    link.origin_m = joints[i].origin.position_m;
    link.origin = joints[i].origin.orientation.toRotationMatrix();
    link.mass = links[i];
    links_.push_back(link);
  }
  const auto count = static_cast<Eigen::Index>(joints.size());
  inertia_.setZero(count, count);
  load_.setZero(count);
  velocities_.setZero(count);
}

void ArmDynamics::place(const JointVector& positions, const JointVector& velocities) {
  place_links(positions, velocities);
  find_inertia();
  find_load(velocities);
}

void ArmDynamics::place_links(const JointVector& positions, const JointVector& velocities) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vector3 position_m = Vector3::Zero();
  Spatial velocity;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    Link& link = links_[i];
    position_m += rotation * link.origin_m;
    rotation *= link.origin;
    const Vector3 axis = rotation * link.axis;
    if (link.revolute) {
      rotation *= Eigen::AngleAxisd(positions[i], link.axis).toRotationMatrix();
      link.motion = {axis, position_m.cross(axis)};
    } else {
      position_m += positions[i] * axis;
      link.motion = {Vector3::Zero(), axis};
    }
    velocity.angular += velocities[i] * link.motion.angular;
    velocity.linear += velocities[i] * link.motion.linear;
    link.velocity = velocity;
    link.rotation = rotation;
    link.com_m = position_m + rotation * link.mass.com_m;

    const Vector3& c = link.com_m;
    link.inertia.mass_kg = link.mass.mass_kg;
    link.inertia.moment_kgm = link.mass.mass_kg * c;
    link.inertia.about_origin_kgm2 =
        rotation * link.mass.inertia_kgm2 * rotation.transpose() +
        link.mass.mass_kg * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  }
}

// What a unit velocity of a joint gives all beyond it, as each joint before feels it.
void ArmDynamics::find_inertia() {
  Inertia beyond;
  for (std::size_t i = links_.size(); i-- > 0;) {
    beyond += links_[i].inertia;
    const Spatial momentum = beyond.momentum(links_[i].motion);
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j <= i; ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      inertia_(row, column) = inertia_(column, row) = power(links_[j].motion, momentum);
    }
  }
}

// The forces that keep the joints' velocities as they are, with the base accelerated upwards in
// place of the weight.
void ArmDynamics::find_load(const JointVector& velocities) {
  std::array<Spatial, kMaxJoints> forces;
  Spatial acceleration{Vector3::Zero(), -gravity_mps2_};
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    const Spatial turning = cross_motion(link.velocity, link.motion);
    acceleration.angular += velocities[i] * turning.angular;
    acceleration.linear += velocities[i] * turning.linear;
    forces[i] = link.inertia.momentum(acceleration);
    const Spatial swept = cross_force(link.velocity, link.inertia.momentum(link.velocity));
    forces[i].angular += swept.angular;
    forces[i].linear += swept.linear;
  }
  Spatial force;
  for (std::size_t i = links_.size(); i-- > 0;) {
    force.angular += forces[i].angular;
    force.linear += forces[i].linear;
    load_(static_cast<Eigen::Index>(i)) = power(links_[i].motion, force);
    velocities_(static_cast<Eigen::Index>(i)) = velocities[i];
  }
}

JointVector ArmDynamics::velocities_after(std::span<const JointMotor> motors, double step_s) const {
  Matrix matrix = inertia_;
  Vector momentum = inertia_ * velocities_ - step_s * load_;
  for (Eigen::Index i = 0; i < momentum.size(); ++i) {
    const JointMotor& motor = motors[static_cast<std::size_t>(i)];
    matrix(i, i) += step_s * motor.impedance;
    momentum(i) += step_s * motor.impedance * motor.velocity;
  }
  matrix.llt().solveInPlace(momentum);
  JointVector velocities{};
  Eigen::Map<Vector>(velocities.data(), momentum.size()) = momentum;
  return velocities;
}

BodyState ArmDynamics::link(std::size_t i) const {
  const Link& link = links_[i];
  const Vector3& omega_radps = link.velocity.angular;
  return {{link.com_m, Eigen::Quaterniond(link.rotation)},
          link.velocity.linear + omega_radps.cross(link.com_m),
          omega_radps};
}

void ArmDynamics::Inertia::operator+=(const Inertia& other) {
  mass_kg += other.mass_kg;
  moment_kgm += other.moment_kgm;
  about_origin_kgm2 += other.about_origin_kgm2;
}

ArmDynamics::Spatial ArmDynamics::Inertia::momentum(const Spatial& velocity) const {
  return {about_origin_kgm2 * velocity.angular + moment_kgm.cross(velocity.linear),
          mass_kg * velocity.linear + velocity.angular.cross(moment_kgm)};
}

ArmDynamics::Spatial ArmDynamics::cross_motion(const Spatial& velocity, const Spatial& motion) {
  return {velocity.angular.cross(motion.angular),
          velocity.angular.cross(motion.linear) + velocity.linear.cross(motion.angular)};
}

ArmDynamics::Spatial ArmDynamics::cross_force(const Spatial& velocity, const Spatial& momentum) {
  return {velocity.angular.cross(momentum.angular) + velocity.linear.cross(momentum.linear),
          velocity.angular.cross(momentum.linear)};
}

double ArmDynamics::power(const Spatial& motion, const Spatial& force) {
  return motion.angular.dot(force.angular) + motion.linear.dot(force.linear);
}

}  // namespace tenon::sim
