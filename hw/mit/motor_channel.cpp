#include "hw/mit/motor_channel.h"

#include <algorithm>
#include <cmath>

#include "shared/mit/constants.h"

namespace tenon::hw::mit {
namespace {

namespace wire = tenon::mit;

constexpr double kFullScale = 65535.0;
/// Of the integral part, in the joint's largest effort: masses are never that wrong.
constexpr double kIntegralShare = 0.5;

}  // namespace

MotorChannel::MotorChannel(const Joint& joint, std::uint32_t cycle_us)
    : node_(joint.node),
      motor_(mit_motor(joint)),
      sign_(joint.counts_per_unit < 0.0 ? -1.0 : 1.0),
      offset_rad_((joint.zero_counts / kFullScale * 2.0 - 1.0) * motor_.position_max_rad),
      effort_max_(joint.effort_max),
      cycle_s_(1e-6 * cycle_us),
      next_(special_frame(joint.node, wire::kDisable)) {}

void MotorChannel::reset() {
  seen_ = reached_on_ = false;
  feedback_ = {};
  held_.reset();
  sent_ = integral_Nm_ = 0.0;
  next_ = special_frame(node_, wire::kDisable);
}

bool MotorChannel::take_feedback(const CanFrame& frame) {
  const auto feedback = decode_feedback(node_, motor_, frame);
  if (!feedback) return false;
  feedback_ = *feedback;
  seen_ = true;
  return true;
}

bool MotorChannel::is_target(double setpoint) { return std::isfinite(setpoint); }

bool MotorChannel::on() const { return seen_ && feedback_.state == wire::kStateOn; }

bool MotorChannel::faulty() const {
  return feedback_.state != wire::kStateOn && feedback_.state != wire::kStateOff;
}

double MotorChannel::position() const { return sign_ * (feedback_.position_rad - offset_rad_); }

double MotorChannel::effort() const { return sign_ * feedback_.torque_Nm; }

void MotorChannel::update(ArmRequest request, bool follow, double setpoint, double gravity_Nm) {
  reached_on_ = request == ArmRequest::kEnabled && (reached_on_ || on());
  if (request == ArmRequest::kDisabled) {
    held_.reset();
    integral_Nm_ = 0.0;
    next_ = special_frame(node_, wire::kDisable);
    return;
  }
  if (!on()) {
    held_.reset();
    integral_Nm_ = 0.0;
    if (request == ArmRequest::kQuickStop) {
      next_ = special_frame(node_, wire::kDisable);
    } else {
      next_ = special_frame(node_, faulty() ? wire::kClearError : wire::kEnable);
    }
    return;
  }
  double velocity = 0.0;
  if (follow) {
    velocity = (setpoint - sent_) / cycle_s_;
    held_.reset();
  } else {
    if (!held_) {
      held_ = position();
      sent_ = *held_;
    }
    setpoint = *held_;
  }
  next_ = command_frame(node_, motor_, hold(setpoint, velocity, gravity_Nm));
  sent_ = setpoint;
}

// The position that has just come answers the setpoint that was sent before.
MotorCommand MotorChannel::hold(double setpoint, double velocity, double gravity_Nm) {
  const double error = sent_ - position();
  const double most_Nm = kIntegralShare * effort_max_;
  integral_Nm_ += motor_.stiffness_Nmprad / kIntegralTime_s * error * cycle_s_;
  integral_Nm_ = std::clamp(integral_Nm_, -most_Nm, most_Nm);
  return {sign_ * setpoint + offset_rad_, sign_ * velocity, motor_.stiffness_Nmprad,
          motor_.damping_Nmsprad, sign_ * (gravity_Nm + integral_Nm_)};
}

}  // namespace tenon::hw::mit
