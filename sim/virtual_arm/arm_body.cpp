#include "sim/virtual_arm/arm_body.h"

#include <algorithm>
#include <cmath>

#include "shared/base/error.h"

namespace tenon::sim {
namespace {

constexpr double kGravity_mps2 = 9.81;
constexpr double kIntegralTime_s = 0.02;
constexpr double kBrakeStrength = 2.0;   // in effort_max
constexpr double kBrakeSoftness = 1e-9;  // m/s per N
constexpr double kEndStopMargin_m = 0.005;
constexpr double kLinkRadius_m = 0.15;  // of the sphere whose inertia a link has
constexpr double kPayloadRadius_m = 0.05;
constexpr double kPayloadMassMin_kg = 0.01;

dBodyID make_body(const OdeWorld& world, const Pose& pose, double mass_kg, double radius_m) {
  const dBodyID body = dBodyCreate(world.id());
  dMass mass;
  dMassSetSphereTotal(&mass, mass_kg, radius_m);
  dBodySetMass(body, &mass);
  set_pose(body, pose);
  return body;
}

void translate(dBodyID body, const Vector3& by_m) {
  const dReal* p = dBodyGetPosition(body);
  dBodySetPosition(body, p[0] + by_m.x(), p[1] + by_m.y(), p[2] + by_m.z());
}

Vector3 vector_of(const dReal* v) { return {v[0], v[1], v[2]}; }

}  // namespace

ArmBody::ArmBody(const Cell& cell, const Task& task, const Parameters& parameters)
    : scene_(task.held, task.environment, parameters.X_BE),
      surface_(parameters.surface),
      servo_lag_s_(parameters.servo_lag_s) {
  dWorldSetGravity(world_.id(), 0.0, 0.0, -kGravity_mps2);
  build_links(cell);
  scene_.attach(payload_, X_LP_);
  move_to(parameters.start_m);
}

void ArmBody::build_links(const Cell& cell) {
  Pose X_BL;
  dBodyID parent = nullptr;
  double carried_kg = std::max(cell.payload_mass_kg, kPayloadMassMin_kg);
  for (const Joint& joint : cell.robot.joints) carried_kg += joint.link.mass_kg;
  for (const Joint& joint : cell.robot.joints) {
    if (joint.kind != Joint::Kind::kPrismatic) {
      throw InputError("robot " + cell.robot.name + ": joint " + joint.name +
                       " is revolute; the virtual arm moves prismatic joints only");
    }
    X_BL = compose(X_BL, joint.origin);
    const Vector3 axis = X_BL.orientation * joint.axis;
    ServoJoint servo;
    servo.link = make_body(world_, X_BL, joint.link.mass_kg, kLinkRadius_m);
    servo.slider = dJointCreateSlider(world_.id(), nullptr);
    dJointAttach(servo.slider, servo.link, parent);
    dJointSetSliderAxis(servo.slider, axis.x(), axis.y(), axis.z());
    dJointSetSliderParam(servo.slider, dParamLoStop, joint.lower - kEndStopMargin_m);
    dJointSetSliderParam(servo.slider, dParamHiStop, joint.upper + kEndStopMargin_m);
    servo.effort_max_N = joint.effort_max;
    servo.stiffness_Npm = cell.robot.stiffness_Npm;
    servo.damping_Nspm = 2.0 * std::sqrt(servo.stiffness_Npm * carried_kg);
    carried_kg -= joint.link.mass_kg;
    parent = servo.link;
    joints_.push_back(servo);
  }
  build_payload(cell, compose(X_BL, cell.robot.flange));
}

void ArmBody::build_payload(const Cell& cell, const Pose& X_BF) {
  const Pose X_FL = compose(cell.X_FS, Pose{cell.payload_com_m, {1.0, 0.0, 0.0, 0.0}});
  payload_ = make_body(world_, compose(X_BF, X_FL),
                       std::max(cell.payload_mass_kg, kPayloadMassMin_kg), kPayloadRadius_m);
  mount_ = dJointCreateFixed(world_.id(), nullptr);
  dJointAttach(mount_, payload_, joints_.back().link);
  dJointSetFixed(mount_);
  dJointSetFeedback(mount_, &mount_feedback_);
  X_LP_ = compose(inverse(X_FL), cell.X_FP);
  sensor_m_ = -cell.payload_com_m;
}

// Joints read zero where they were made, so the chain is made at zero and moved afterwards.
void ArmBody::move_to(const JointVector& start_m) {
  Vector3 shift_m = Vector3::Zero();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    dVector3 axis;
    dJointGetSliderAxis(joints_[i].slider, axis);
    shift_m += start_m[i] * vector_of(axis);
    translate(joints_[i].link, shift_m);
  }
  translate(payload_, shift_m);
  for (ServoJoint& joint : joints_) {
    joint.state.position_m = dJointGetSliderPosition(joint.slider);
  }
}

void ArmBody::step(const std::vector<JointDemand>& demands, double step_s) {
  for (std::size_t i = 0; i < joints_.size(); ++i) drive(joints_[i], demands[i], step_s);
  scene_.collide(world_, step_s, surface_);
  const std::uint64_t messages_before = ode_messages();
  world_.step(step_s);
  solver_messages_ += ode_messages() - messages_before;
  for (ServoJoint& joint : joints_) read(joint);
  read_wrench();
}

void ArmBody::drive(ServoJoint& joint, const JointDemand& demand, double step_s) {
  if (demand.brake) {
    joint.braked = true;
    joint.followed_m = joint.state.position_m;
    joint.command_velocity_mps = 0.0;
    joint.softness = kBrakeSoftness;
    joint.force_max_N = kBrakeStrength * joint.effort_max_N;
  } else {
    follow(joint, demand, step_s);
  }
  dJointSetSliderParam(joint.slider, dParamVel, joint.command_velocity_mps);
  dJointSetSliderParam(joint.slider, dParamCFM, joint.softness);
  dJointSetSliderParam(joint.slider, dParamFMax, joint.force_max_N);
}

void ArmBody::follow(ServoJoint& joint, const JointDemand& demand, double step_s) {
  // At release the integral part starts with what the brake held (read() left it there), so that a
  // vertical axis does not drop.
  const double lag_m = joint.followed_m - joint.state.position_m;
  const bool saturated =
      std::abs(joint.state.effort_N) >= joint.effort_max_N && lag_m * joint.state.effort_N > 0.0;
  if (!joint.braked && !saturated) {
    joint.integral_N += joint.stiffness_Npm / kIntegralTime_s * lag_m * step_s;
    joint.integral_N = std::clamp(joint.integral_N, -joint.effort_max_N, joint.effort_max_N);
  }
  joint.braked = false;

  double velocity_mps = demand.velocity_mps;
  if (servo_lag_s_ > 0.0) {
    const double part = 1.0 - std::exp(-step_s / servo_lag_s_);
    velocity_mps = part * (demand.position_m - joint.followed_m) / step_s;
    joint.followed_m += velocity_mps * step_s;
  } else {
    joint.followed_m = demand.position_m;
  }
  // The spring acts on the error at the end of the step, which makes it stable however stiff.
  const double error_m = joint.followed_m - joint.state.position_m;
  const double impedance = step_s * joint.stiffness_Npm + joint.damping_Nspm;
  joint.command_velocity_mps =
      (joint.stiffness_Npm * error_m + joint.damping_Nspm * velocity_mps + joint.integral_N) /
      impedance;
  joint.softness = 1.0 / impedance;
  joint.force_max_N = joint.effort_max_N;
}

void ArmBody::read(ServoJoint& joint) {
  joint.state.position_m = dJointGetSliderPosition(joint.slider);
  joint.state.velocity_mps = dJointGetSliderPositionRate(joint.slider);
  const double force_N =
      std::clamp((joint.command_velocity_mps - joint.state.velocity_mps) / joint.softness,
                 -joint.force_max_N, joint.force_max_N);
  joint.state.effort_N = joint.braked ? 0.0 : force_N;
  if (joint.braked) joint.integral_N = std::clamp(force_N, -joint.effort_max_N, joint.effort_max_N);
}

void ArmBody::read_wrench() {
  // ODE reports the mount's force on the payload, and the torque about its centre of mass.
  const Pose body = pose_of(payload_);
  const Vector3 force_N = body.orientation.conjugate() * vector_of(mount_feedback_.f1);
  const Vector3 torque_Nm = body.orientation.conjugate() * vector_of(mount_feedback_.t1);
  wrench_.head<3>() = -force_N;
  wrench_.tail<3>() = -(torque_Nm - sensor_m_.cross(force_N));
}

Pose ArmBody::tool() const { return compose(pose_of(payload_), X_LP_); }

}  // namespace tenon::sim
