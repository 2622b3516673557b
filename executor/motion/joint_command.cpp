#include "executor/motion/joint_command.h"

#include <cmath>

namespace tenon::executor {
namespace {

// From one cycle to the next Newton's steps converge in two or three; more cost time for nothing.
constexpr int kIterations = 12;
// Rounding of the commanded position is no excess.
constexpr double kRounding = 1.0 + 1e-6;

}  // namespace

JointCommand::JointCommand(const Robot& robot, const ToolKinematics& kinematics)
    : robot_(robot), kinematics_(kinematics), cycle_s_(1e-6 * robot.cycle_us) {}

void JointCommand::rest_at(const JointVector& position) {
  position_ = position;
  velocity_ = {};
}

JointVector JointCommand::velocity_to(const JointVector& next) const {
  JointVector velocity{};
  for (std::size_t i = 0; i < kMaxJoints; ++i) velocity[i] = (next[i] - position_[i]) / cycle_s_;
  return velocity;
}

std::optional<Ending> JointCommand::follow(const Pose& tool) {
  SerialChain::InverseParameters parameters;
  parameters.iterations_max = kIterations;
  parameters.respect_limits = false;
  const SerialChain::Inverse inverse = kinematics_.joints(tool, position_, parameters);
  if (inverse.status == SerialChain::InverseStatus::kSolved) return follow(inverse.position);
  return Ending{.reason = EndReason::kUnreachable, .value = inverse.error};
}

std::optional<Ending> JointCommand::follow(const JointVector& position) {
  const JointVector velocity = velocity_to(position);
  const JointVector rest = JointStop(position, velocity, robot_).end();
  for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
    const Joint& joint = robot_.joints[i];
    const int index = static_cast<int>(i);
    if (std::abs(velocity[i]) > joint.speed_max * kRounding) {
      return Ending{.reason = EndReason::kJointSpeed,
                    .index = index,
                    .value = std::abs(velocity[i]),
                    .bound = joint.speed_max};
    }
    if (rest[i] < joint.lower || rest[i] > joint.upper) {
      return Ending{.reason = EndReason::kJointLimit,
                    .index = index,
                    .value = rest[i],
                    .bound = rest[i] < joint.lower ? joint.lower : joint.upper};
    }
  }
  position_ = position;
  velocity_ = velocity;
  return std::nullopt;
}

void JointCommand::stop() {
  stop_ = JointStop(position_, velocity_, robot_);
  stop_time_s_ = 0.0;
}

void JointCommand::ramp() {
  stop_time_s_ += cycle_s_;
  const JointVector next = stop_.at(stop_time_s_);
  velocity_ = velocity_to(next);
  position_ = next;
}

}  // namespace tenon::executor
