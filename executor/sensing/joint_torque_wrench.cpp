#include "executor/sensing/joint_torque_wrench.h"

#include <algorithm>
#include <cmath>

#include "shared/joint_torque/friction_memory.h"

namespace tenon::executor {
namespace {

// Differences of counts are coarse; viscous friction changes slowly.
constexpr double kVelocityFilter_s = 0.01;

using JointColumn = Eigen::Matrix<double, static_cast<int>(kMaxJoints), 1>;

/// Share of a step that a filter of first order takes within a cycle.
double share(double cycle_s, double filter_s) { return cycle_s / (cycle_s + filter_s); }

}  // namespace

Cell sensed_cell(Cell cell) {
  if (!cell.joint_torque) return cell;
  cell.X_FS = cell.X_FP;
  cell.payload_mass_kg = 0.0;
  cell.payload_com_m.setZero();
  return cell;
}

JointTorqueWrench::JointTorqueWrench(const Cell& cell)
    : count_(cell.robot.joints.size()),
      cycle_s_(1e-6 * cell.robot.cycle_us),
      dynamics_(cell),
      map_(cell) {
  const auto& joints = cell.joint_torque->joints;
  std::copy(joints.begin(), joints.end(), friction_.begin());
}

void JointTorqueWrench::feel(ArmFeedback& feedback) noexcept {
  feedback.wrench_fresh = false;
  ++cycles_;
  if (feedback.joints_fresh != (1U << count_) - 1U) return;
  for (std::size_t i = 0; i < count_; ++i) {
    if (!std::isfinite(feedback.position[i]) || !std::isfinite(feedback.effort[i])) return;
  }
  take_off(feedback);
  at_ = map_.at(position_);
  Vector6 wrench = at_.to_wrench * Eigen::Map<const JointColumn>(external_.data());
  for (int axis = 0; axis < 6; ++axis) {
    if ((at_.axes >> axis & 1U) == 0) wrench[axis] = 0.0;
  }
  const double part = filtering_ ? share(cycle_s_, kEffortFilterCycles * cycle_s_) : 1.0;
  filtering_ = true;
  filtered_ += part * (wrench - filtered_);
  const Eigen::Quaterniond to_tool = R_PT();
  feedback.wrench << to_tool * filtered_.head<3>(), to_tool * filtered_.tail<3>();
  feedback.wrench_fresh = true;
  feedback.wrench_counter = ++counter_;
}

// A drive reports the mean effort of its last cycle, the encoders the mean velocity: of two cycles
// the one is a force, of their difference the other an acceleration, at one time.
void JointTorqueWrench::take_off(const ArmFeedback& feedback) noexcept {
  const double passed_s = cycles_ * cycle_s_;
  cycles_ = 0;
  JointVector acceleration{};
  JointVector effort{};
  JointVector rubbed{};
  for (std::size_t i = 0; i < count_; ++i) {
    const JointFriction& friction = friction_[i];
    const double moved = known_ > 0 ? feedback.position[i] - position_[i] : 0.0;
    const double speed = moved / passed_s;
    if (known_ > 1) acceleration[i] = 2.0 * (speed - speed_[i]) / (passed_s + before_s_);
    speed_[i] = speed;
    velocity_[i] += share(passed_s, kVelocityFilter_s) * (speed - velocity_[i]);
    effort[i] = 0.5 * (feedback.effort[i] + (known_ > 0 ? effort_[i] : feedback.effort[i]));
    effort_[i] = feedback.effort[i];
    const auto dry = [&] { return friction.coulomb * z_[i] + friction.hysteresis * z_gear_[i]; };
    const double dry_before = dry();
    z_[i] = friction_after(z_[i], moved, friction.way);
    z_gear_[i] = friction_after(z_gear_[i], moved, friction.hysteresis_way);
    rubbed[i] = 0.5 * (dry_before + dry()) + friction.viscous * velocity_[i] + friction.offset;
  }
  position_ = feedback.position;
  before_s_ = passed_s;
  known_ = std::min(known_ + 1, 2);
  const JointVector own = dynamics_.effort(position_, velocity_, acceleration);
  for (std::size_t i = 0; i < count_; ++i) {
    rubbing_[i] = effort[i] - own[i];
    // A joint's effort holds against what pushes it.
    external_[i] = rubbed[i] - rubbing_[i];
  }
}

Vector6 JointTorqueWrench::settle(const Vector6& mean) noexcept {
  const Eigen::Quaterniond to_task = R_PT().conjugate();
  Vector6 left;
  left << to_task * mean.head<3>(), to_task * mean.tail<3>();
  const JointColumn efforts = at_.jacobian.transpose() * left;
  JointColumn taken = JointColumn::Zero();
  for (std::size_t i = 0; i < count_; ++i) {
    const double most = friction_[i].coulomb + friction_[i].hysteresis;
    if (!(most > 0.0)) continue;
    // Both came to rest in one motion, for all that is known.
    const double by = efforts[static_cast<int>(i)] / most;
    const double z = std::clamp(z_[i] - by, -1.0, 1.0);
    const double z_gear = std::clamp(z_gear_[i] - by, -1.0, 1.0);
    taken[static_cast<int>(i)] =
        friction_[i].coulomb * (z - z_[i]) + friction_[i].hysteresis * (z_gear - z_gear_[i]);
    z_[i] = z;
    z_gear_[i] = z_gear;
  }
  // External efforts grow by what friction is now said to take more.
  const Vector6 more = at_.to_wrench * taken;
  filtered_ += more;
  left += more;
  const Eigen::Quaterniond to_tool = R_PT();
  Vector6 settled;
  settled << to_tool * left.head<3>(), to_tool * left.tail<3>();
  return settled;
}

Eigen::Quaterniond JointTorqueWrench::R_PT() const noexcept {
  return map_.tool(position_).orientation.conjugate();
}

}  // namespace tenon::executor
