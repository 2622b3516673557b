#include "sim/cell/virtual_arm/servo_joint.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tenon::sim {
namespace {

constexpr double kBrakeStrength = 2.0;   // in effort_max
constexpr double kBrakeSoftness = 1e-9;  // m/s per N, rad/s per Nm
constexpr double kEndStopMargin = 0.005;
// An integral part that is faster than this, in periods of the spring over 2 pi, would ring.
constexpr double kIntegralPeriodsMin = 4.0;
constexpr double kLeastImpedance = 1e-6;  // N s/m, Nm s/rad: a motor row needs some
constexpr double kPlayDamping = 0.02;     // of the grease between the flanks, in D

}  // namespace

ServoJoint::ServoJoint(const OdeWorld& world, const Joint& joint, const Parameters& parameters,
                       dBodyID link, dBodyID parent, const Vector3& anchor_m, const Vector3& axis,
                       double position)
    : link_(link),
      revolute_(joint.kind == Joint::Kind::kRevolute),
      lower_(joint.lower),
      upper_(joint.upper),
      effort_max_(joint.effort_max),
      stiffness_(joint.stiffness),
      parameters_(parameters),
      offset_(position),
      followed_(position) {
  if (revolute_) {
    joint_ = dJointCreateHinge(world.id(), nullptr);
    dJointAttach(joint_, link, parent);
    dJointSetHingeAnchor(joint_, anchor_m.x(), anchor_m.y(), anchor_m.z());
    dJointSetHingeAxis(joint_, axis.x(), axis.y(), axis.z());
  } else {
    joint_ = dJointCreateSlider(world.id(), nullptr);
    dJointAttach(joint_, link, parent);
    dJointSetSliderAxis(joint_, axis.x(), axis.y(), axis.z());
  }
  dJointSetFeedback(joint_, &feedback_);
  set_stops();
  state_.position = state_.encoder = position;
}

Vector3 ServoJoint::axis() const {
  dVector3 axis;
  revolute_ ? dJointGetHingeAxis(joint_, axis) : dJointGetSliderAxis(joint_, axis);
  return vector_of(axis);
}

Vector3 ServoJoint::anchor_m() const {
  if (!revolute_) return vector_of(dBodyGetPosition(link_));
  dVector3 anchor;
  dJointGetHingeAnchor(joint_, anchor);
  return vector_of(anchor);
}

double ServoJoint::raw_position() const {
  return revolute_ ? dJointGetHingeAngle(joint_) : dJointGetSliderPosition(joint_);
}

void ServoJoint::set(int parameter, double value) {
  revolute_ ? dJointSetHingeParam(joint_, parameter, value)
            : dJointSetSliderParam(joint_, parameter, value);
}

void ServoJoint::set_stops() {
  set(dParamLoStop, lower_ - kEndStopMargin - offset_);
  set(dParamHiStop, upper_ + kEndStopMargin - offset_);
}

void ServoJoint::drive(const Demand& demand, double inertia, double step_s) {
  follows_ = demand.powered && !demand.brake;
  if (follows_ && demand.impedance) return yield(demand, step_s);
  if (follows_) return follow(demand, inertia, step_s);
  followed_ = state_.encoder;
  motor_ = {};
  if (demand.brake) motor_ = {0.0, 1.0 / kBrakeSoftness, kBrakeStrength * effort_max_};
}

void ServoJoint::follow(const Demand& demand, double inertia, double step_s) {
  const double frequency_radps = std::sqrt(stiffness_ / inertia);
  double damping = 2.0 * inertia * frequency_radps;
  const double effort_max = std::min(demand.effort_max, effort_max_);
  // At release the integral part starts with what the brake held (read() left it there), so that an
  // axis under load does not drop.
  const double error = followed_ - state_.encoder;
  const bool saturated = std::abs(state_.effort) >= effort_max && error * state_.effort > 0.0;
  if (parameters_.integral_time_s > 0.0 && !saturated) {
    const double time_s =
        std::max(parameters_.integral_time_s, kIntegralPeriodsMin / frequency_radps);
    integral_ += stiffness_ / time_s * error * step_s;
  }
  integral_ = std::clamp(integral_, -effort_max, effort_max);

  double velocity = demand.velocity;
  if (parameters_.lag_s > 0.0) {
    const double part = 1.0 - std::exp(-step_s / parameters_.lag_s);
    velocity = part * (demand.position - followed_) / step_s;
    followed_ += velocity * step_s;
  } else {
    followed_ = demand.position;
  }

  const double play = play_at(state_.position);
  const bool drives = std::abs(play) >= 0.5 * parameters_.backlash;
  // The spring acts on the error at the end of the step, which makes it stable however stiff.
  double spring = stiffness_;
  double pull = stiffness_ * (followed_ - state_.position - play) + integral_;
  if (!drives) {
    spring = pull = 0.0;
    damping *= kPlayDamping;
  }
  const double impedance = step_s * spring + damping;
  motor_ = {(pull + damping * velocity) / impedance, impedance, effort_max};
}

// Spring and damper act on what there is at the end of the step, as in follow().
void ServoJoint::yield(const Demand& demand, double step_s) {
  const VirtualDrive::Impedance& set = *demand.impedance;
  followed_ = state_.encoder;
  integral_ = 0.0;
  const double pull = set.stiffness * (demand.position - state_.position) + set.effort;
  const double impedance = std::max(step_s * set.stiffness + set.damping, kLeastImpedance);
  motor_ = {(pull + set.damping * demand.velocity) / impedance, impedance,
            std::min(demand.effort_max, effort_max_)};
}

// Without load the motor would stand at q_d + I / K; the link is in its way beyond the play.
double ServoJoint::play_at(double position) const {
  const double half = 0.5 * parameters_.backlash;
  return std::clamp(followed_ + integral_ / stiffness_ - position, -half, half);
}

bool ServoJoint::clear_of_stops() const {
  return lower_ < state_.position && state_.position < upper_;
}

void ServoJoint::moved(double position, double velocity) {
  state_.position = position;
  state_.velocity = velocity;
  settle(motor_.effort_at(velocity));
}

void ServoJoint::stand() {
  raw_ = raw_position();
  offset_ = state_.position - raw_;
  set_stops();
}

void ServoJoint::load() {
  step_axis_ = axis();
  step_lever_m_ = anchor_m() - vector_of(dBodyGetPosition(link_));
  set(dParamVel, motor_.velocity);
  set(dParamCFM, 1.0 / std::max(motor_.impedance, kLeastImpedance));
  set(dParamFMax, motor_.effort_max);
}

// ODE reports the joint's whole force on the link, its torque about the centre of mass.
double ServoJoint::raw_effort() const {
  const Vector3 force_N = vector_of(feedback_.f1);
  if (!revolute_) return step_axis_.dot(force_N);
  return step_axis_.dot(vector_of(feedback_.t1) - step_lever_m_.cross(force_N));
}

void ServoJoint::read() {
  const double raw = raw_position();
  if (revolute_ && std::abs(raw - raw_) > std::numbers::pi) {
    offset_ -= std::copysign(2.0 * std::numbers::pi, raw - raw_);
    set_stops();
  }
  raw_ = raw;
  state_.position = raw + offset_;
  state_.velocity =
      revolute_ ? dJointGetHingeAngleRate(joint_) : dJointGetSliderPositionRate(joint_);

  settle(raw_effort());
}

// The brake's effort is kept, for a servo that takes over to begin with.
void ServoJoint::settle(double effort) {
  effort = std::clamp(effort, -motor_.effort_max, motor_.effort_max);
  state_.effort = follows_ ? effort : 0.0;
  if (follows_) {
    play_ = play_at(state_.position);
  } else {
    integral_ = parameters_.integral_time_s > 0.0 ? effort : 0.0;
  }
  state_.encoder = state_.position + play_;
}

}  // namespace tenon::sim
