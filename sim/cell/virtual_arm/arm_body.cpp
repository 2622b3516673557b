#include "sim/cell/virtual_arm/arm_body.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "shared/base/error.h"
#include "sim/cell/virtual_arm/composite_inertia.h"

namespace tenon::sim {
namespace {

constexpr double kGravity_mps2 = 9.80665;
// A mass without an inertia is a ball of this size.
constexpr double kLinkRadius_m = 0.15;
constexpr double kPayloadRadius_m = 0.05;
constexpr double kPayloadMassMin_kg = 0.01;
// m/(Ns), of friction as of all that is stiff: 20 N let a part creep by 2 um in a second. With a
// hundredth of it the solver takes the rows of friction on a part that is next to massless for one
// another, and gives up.
constexpr double kSoftness = 1e-7;

Eigen::Matrix3d ball_kgm2(double mass_kg, double radius_m) {
  return 0.4 * mass_kg * radius_m * radius_m * Eigen::Matrix3d::Identity();
}

Pose at(const Vector3& position_m) { return {position_m, {1.0, 0.0, 0.0, 0.0}}; }

LinkInertia checked(const Robot& robot, const Joint& joint) {
  LinkInertia link = joint.link;
  const auto refuse = [&](const std::string& what) {
    throw InputError("robot " + robot.name + ": the link behind joint " + joint.name + " has " +
                     what);
  };
  if (!(joint.stiffness > 0.0)) refuse("a servo without stiffness; give the joint one");
  if (!(link.mass_kg > 0.0)) refuse("mass " + std::to_string(link.mass_kg) + " kg, must be > 0");
  if (link.inertia_kgm2.isZero(0.0)) link.inertia_kgm2 = ball_kgm2(link.mass_kg, kLinkRadius_m);
  const Eigen::LLT<Eigen::Matrix3d> factor(link.inertia_kgm2);
  if (factor.info() != Eigen::Success) refuse("an inertia that is not positive definite");
  return link;
}

}  // namespace

ArmBody::ArmBody(const Cell& cell, const Task& task, const Parameters& parameters)
    : scene_(task.held, task.environment, parameters.X_BE),
      contact_law_(parameters.contact_law),
      gravity_mps2_(-kGravity_mps2 * cell.up_B) {
  dWorldSetGravity(world_.id(), gravity_mps2_.x(), gravity_mps2_.y(), gravity_mps2_.z());
  dWorldSetCFM(world_.id(), kSoftness);
  build(cell, parameters);
  const double series_Npm = parameters.contact_law.stiffness_Npm;
  contact_law_.stiffness_Npm = part_stiffness_Npm(series_Npm);
  part_.emplace(world_, joints_.back().link(), arm_give_mpN(series_Npm));
  scene_.attach(part_->body(), X_OP_);
}

void ArmBody::build(const Cell& cell, const Parameters& parameters) {
  const std::vector<Joint>& joints = cell.robot.joints;
  for (const Joint& joint : joints) links_.push_back(checked(cell.robot, joint));
  links_.back() = with_payload(cell, links_.back());

  Pose X_BL;
  dBodyID parent = nullptr;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = joints[i];
    const bool revolute = joint.kind == Joint::Kind::kRevolute;
    X_BL = compose(X_BL, joint.origin);
    const Vector3 axis = X_BL.orientation * joint.axis;
    const Vector3 motion = parameters.start[i] * joint.axis;
    X_BL = compose(X_BL, revolute ? Pose{Vector3::Zero(), rotation_of(motion)} : at(motion));
    const dBodyID body = make_body(X_BL, links_[i]);
    joints_.emplace_back(
        world_, joint,
        ServoJoint::Parameters{parameters.servo_lag_s, parameters.integral_time_s,
                               revolute ? parameters.backlash_rad : parameters.backlash_m},
        body, parent, X_BL.position_m, axis, parameters.start[i]);
    parent = body;
  }
  dynamics_.emplace(joints, links_, gravity_mps2_);
  motors_.resize(joints.size());
  place();
  momentum_ = load_momentum();
}

dBodyID ArmBody::make_body(const Pose& X_BL, const LinkInertia& link) {
  const dBodyID body = dBodyCreate(world_.id());
  const Eigen::Matrix3d& I = link.inertia_kgm2;
  dMass mass;
  dMassSetParameters(&mass, link.mass_kg, 0.0, 0.0, 0.0, I(0, 0), I(1, 1), I(2, 2), I(0, 1),
                     I(0, 2), I(1, 2));
  dBodySetMass(body, &mass);
  set_pose(body, compose(X_BL, at(link.com_m)));
  return body;
}

// The last link and all that hangs on it as one body; its origin is the common centre of mass.
LinkInertia ArmBody::with_payload(const Cell& cell, const LinkInertia& link) {
  const Pose X_LS = compose(cell.robot.flange, cell.X_FS);
  load_.mass_kg = std::max(cell.payload_mass_kg, kPayloadMassMin_kg);
  load_.inertia_kgm2 = ball_kgm2(load_.mass_kg, kPayloadRadius_m);
  load_.com_m = compose(X_LS, at(cell.payload_com_m)).position_m;

  CompositeInertia composite;
  composite.add(link.mass_kg, link.com_m, link.inertia_kgm2);
  composite.add(load_.mass_kg, load_.com_m, load_.inertia_kgm2);
  LinkInertia both = composite.sum();
  const Pose X_OL = at(-both.com_m);
  load_.com_m -= both.com_m;
  X_OS_ = compose(X_OL, X_LS);
  X_OP_ = compose(X_OL, compose(cell.robot.flange, cell.X_FP));
  return both;
}

void ArmBody::step(std::span<const ServoJoint::Demand> demands, double step_s) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    joints_[i].drive(demands[i], dynamics_->inertia(i), step_s);
    motors_[i] = joints_[i].motor();
  }
  scene_.placed();
  const bool touched = scene_.find_contacts(/*turns=*/true).points > 0;
  scene_.make_joints(world_, step_s, contact_law_);
  if (touched || !part_->there() || !move_freely(step_s)) move_bodies(touched, step_s);
  place();
  if (!bodies_stand_) part_->ride(last_link());
  read_wrench(step_s);
}

bool ArmBody::move_freely(double step_s) {
  const auto is_held = [](const ServoJoint& joint) {
    return joint.clear_of_stops() && joint.motor().impedance > 0.0;
  };
  if (!std::all_of(joints_.begin(), joints_.end(), is_held)) return false;
  const JointVector velocities = dynamics_->velocities_after(motors_, step_s);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (std::abs(motors_[i].effort_at(velocities[i])) > motors_[i].effort_max) return false;
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    joints_[i].moved(joints_[i].state().position + step_s * velocities[i], velocities[i]);
  }
  bodies_stand_ = false;
  return true;
}

void ArmBody::move_bodies(bool touched, double step_s) {
  if (!bodies_stand_) {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      set_state(joints_[i].link(), dynamics_->link(i));
    }
    for (ServoJoint& joint : joints_) joint.stand();
    bodies_stand_ = true;
  }
  for (ServoJoint& joint : joints_) joint.load();
  part_->load(step_s, touched);
  const std::uint64_t messages_before = ode_messages();
  world_.step(step_s);
  solver_messages_ += ode_messages() - messages_before;
  for (ServoJoint& joint : joints_) joint.read();
  part_->look();
}

void ArmBody::place() {
  JointVector positions{};
  JointVector velocities{};
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    positions[i] = joints_[i].state().position;
    velocities[i] = joints_[i].state().velocity;
  }
  dynamics_->place(positions, velocities);
}

Vector6 ArmBody::load_momentum() const {
  const BodyState link = last_link();
  const Eigen::Matrix3d rotation = link.pose.orientation.toRotationMatrix();
  const Vector3 velocity_mps = link.velocity_mps + link.omega_radps.cross(rotation * load_.com_m);
  Vector6 momentum;
  momentum << load_.mass_kg * velocity_mps,
      rotation * load_.inertia_kgm2 * rotation.transpose() * link.omega_radps;
  return momentum;
}

// What the environment and gravity do to the load, less what changes its momentum, has to come
// through the sensor.
void ArmBody::read_wrench(double step_s) {
  const Vector6 before = momentum_;
  momentum_ = load_momentum();
  const Vector6 rate = (momentum_ - before) / step_s;
  const Eigen::Quaterniond orientation = last_link().pose.orientation;
  const Vector3 sensor_m = orientation * X_OS_.position_m;
  const Vector3 weight_N = load_.mass_kg * gravity_mps2_;
  Vector6 contact = scene_.wrench();
  contact.tail<3>() += part_->bent_m().cross(contact.head<3>());

  const Vector3 force_N = weight_N - rate.head<3>();
  const Vector3 torque_Nm = contact.tail<3>() - sensor_m.cross(contact.head<3>()) +
                            (orientation * load_.com_m - sensor_m).cross(force_N) - rate.tail<3>();
  const Eigen::Quaterniond to_sensor = (orientation * X_OS_.orientation).conjugate();
  wrench_ << to_sensor * (contact.head<3>() + force_N), to_sensor * torque_Nm;
}

Pose ArmBody::tool() const { return compose(pose_of(part_->body()), X_OP_); }

double ArmBody::energy_J() const {
  double energy_J = 0.0;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const BodyState link = bodies_stand_ ? state_of(joints_[i].link()) : dynamics_->link(i);
    const Vector3 omega_radps = link.pose.orientation.conjugate() * link.omega_radps;
    energy_J += 0.5 * links_[i].mass_kg * link.velocity_mps.squaredNorm() +
                0.5 * omega_radps.dot(links_[i].inertia_kgm2 * omega_radps) -
                links_[i].mass_kg * gravity_mps2_.dot(link.pose.position_m);
  }
  return energy_J;
}

}  // namespace tenon::sim
