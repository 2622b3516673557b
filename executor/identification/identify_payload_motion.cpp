#include "executor/identification/identify_payload_motion.h"

#include <algorithm>

#include "executor/sensing/wrench_estimator.h"

namespace tenon::executor {
namespace {

constexpr std::size_t kTurnedJoints = 3;
constexpr double kLimitMargin_rad = 0.1;

// The last joints that turn, outermost first.
std::vector<std::size_t> last_turning(const Robot& robot) {
  std::vector<std::size_t> joints;
  for (std::size_t i = robot.joints.size(); i-- > 0 && joints.size() < kTurnedJoints;) {
    if (robot.joints[i].kind == Joint::Kind::kRevolute) joints.push_back(i);
  }
  return joints;
}

// What it is to find out is not known yet.
Cell without_bias(Cell cell) {
  cell.sensor_bias.reset();
  return cell;
}

}  // namespace

IdentifyPayloadMotion::IdentifyPayloadMotion(const Cell& cell, const Parameters& parameters)
    : IdentificationMotion(without_bias(cell)),
      parameters_(parameters),
      turning_(last_turning(cell.robot)),
      reading_(SensorTare::parameters_for(cell.robot.sensor, parameters.samples)) {
  const std::size_t corners = std::size_t{1} << turning_.size();
  poses_.reserve(corners + 1);
  readings_.reserve(corners + 1);
}

// The corners of a box around the first pose, then back to it.
void IdentifyPayloadMotion::begin() {
  const JointVector first = joints().position();
  for (unsigned corner = 0; corner < 1U << turning_.size() && !turning_.empty(); ++corner) {
    JointVector pose = first;
    for (std::size_t k = 0; k < turning_.size(); ++k) {
      const std::size_t turned = turning_[k];
      const Joint& joint = cell().robot.joints[turned];
      const double sign = (corner >> k & 1U) != 0 ? 1.0 : -1.0;
      pose[turned] = std::clamp(pose[turned] + sign * parameters_.turn_rad,
                                joint.lower + kLimitMargin_rad, joint.upper - kLimitMargin_rad);
    }
    poses_.push_back(pose);
  }
  poses_.push_back(first);
  go_on();
}

void IdentifyPayloadMotion::go_on() {
  move_ =
      JointMove(joints().position(), poses_[pose_], cell().robot, kinematics(), parameters_.tool);
  since_s_ = 0.0;
  reading_ = SensorTare(SensorTare::parameters_for(cell().robot.sensor, parameters_.samples));
}

ControlTask::Turn IdentifyPayloadMotion::run(const ArmFeedback& feedback) {
  since_s_ += cycle_s();
  if (const auto refused = joints().follow(move_.at(since_s_))) return *refused;
  if (since_s_ < move_.duration_s() + parameters_.settle_s) return {};
  if (!supervision().wrench_usable()) return {};
  switch (reading_.add(feedback.wrench)) {
    case SensorTare::Status::kGathering:
      return {};
    case SensorTare::Status::kUnsteady:
      return unsteady(reading_);
    case SensorTare::Status::kDone:
      break;
  }
  readings_.push_back(reading());
  if (++pose_ == poses_.size()) return Ending{.reason = EndReason::kMeasured};
  go_on();
  return {};
}

// Of this pose, once it is complete.
RestReading IdentifyPayloadMotion::reading() const {
  const Eigen::Quaterniond R_BS =
      kinematics().chain().flange(supervision().joints()).orientation * cell().X_FS.orientation;
  return {R_BS.conjugate() * Vector3(-kGravity_mps2 * cell().up_B), reading_.mean()};
}

}  // namespace tenon::executor
