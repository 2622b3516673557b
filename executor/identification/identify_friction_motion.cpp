#include "executor/identification/identify_friction_motion.h"

#include <algorithm>
#include <cmath>

#include "shared/base/error.h"

namespace tenon::executor {
namespace {

constexpr double kLimitMargin = 0.02;
constexpr double kTurnOverTool = 3.0;  // rad/s that the tool may turn for each m/s that it may move
// As many as the slowest arm makes, several times over.
constexpr std::size_t kSamplesMost = 1'000'000;

// What it is to find out is not known yet, and the drives' own following error has to do.
Cell unknown(Cell cell) {
  if (!cell.joint_torque) {
    throw InputError("cell '" + cell.name +
                     "': --identify-friction is for a cell that says joint_torque: {}");
  }
  constexpr double kNoForce = 1e9;
  cell.joint_torque->joints.clear();
  cell.force_fault_N = cell.torque_fault_Nm = kNoForce;
  return cell;
}

}  // namespace

IdentifyFrictionMotion::IdentifyFrictionMotion(const Cell& cell, const Parameters& parameters)
    : IdentificationMotion(unknown(cell)), parameters_(parameters) {
  samples_.reserve(kSamplesMost);
  legs_.reserve(cell.robot.joints.size() * (2 * parameters_.tool_mps.size() + 2));
}

void IdentifyFrictionMotion::begin() {
  plan_legs();
  go_on();
}

// Of each joint: to one side, which tells nothing yet, there and back at each speed, to where it
// was.
void IdentifyFrictionMotion::plan_legs() {
  for (std::size_t i = 0; i < cell().robot.joints.size(); ++i) {
    const Joint& joint = cell().robot.joints[i];
    const double way =
        joint.kind == Joint::Kind::kRevolute ? parameters_.way_rad : parameters_.way_m;
    const double first = joints().position()[i];
    const double low = std::max(first - way, std::min(first, joint.lower + kLimitMargin));
    const double high = std::min(first + way, std::max(first, joint.upper - kLimitMargin));
    const double fast = parameters_.tool_mps.back();
    legs_.push_back({i, low, fast, false});
    for (const double speed : parameters_.tool_mps) {
      legs_.push_back({i, high, speed, true});
      legs_.push_back({i, low, speed, true});
    }
    legs_.push_back({i, first, fast, true});
  }
}

void IdentifyFrictionMotion::go_on() {
  const Leg& leg = legs_[leg_];
  JointVector to = joints().position();
  to[leg.joint] = leg.to;
  SpeedLimits tool;
  tool.contact_mps = leg.tool_mps;
  tool.contact_radps = kTurnOverTool * leg.tool_mps;
  move_ = JointMove(joints().position(), to, cell().robot, kinematics(), tool);
  since_s_ = velocity_ = 0.0;
}

ControlTask::Turn IdentifyFrictionMotion::run(const ArmFeedback& feedback) {
  since_s_ += cycle_s();
  if (const auto refused = joints().follow(move_.at(since_s_))) return *refused;
  record(feedback);
  if (since_s_ < move_.duration_s() + parameters_.settle_s) return {};
  if (++leg_ == legs_.size()) return Ending{.reason = EndReason::kMeasured};
  go_on();
  return {};
}

void IdentifyFrictionMotion::record(const ArmFeedback& feedback) {
  const Leg& leg = legs_[leg_];
  const double velocity = joints().velocity()[leg.joint];
  const double acceleration = (velocity - velocity_) / cycle_s();
  velocity_ = velocity;
  if (!feedback.wrench_fresh || samples_.size() == samples_.capacity()) return;
  const bool steady = std::abs(acceleration) <= parameters_.acceleration_most;
  samples_.push_back({static_cast<std::uint8_t>(leg.joint), leg.counts && steady,
                      feedback.position[leg.joint], joint_torque()->velocity()[leg.joint],
                      joint_torque()->rubbing()[leg.joint]});
}

}  // namespace tenon::executor
