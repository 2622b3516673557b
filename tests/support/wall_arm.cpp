#include "tests/support/wall_arm.h"

#include <stdexcept>

namespace tenon::executor {
namespace {

constexpr int kTransitionCycles = 3;
constexpr double kFall_mps2 = 9.80665;

JointVector gantry_joints(const Cell& cell, const Pose& tool) {
  SerialChain::InverseParameters parameters;
  parameters.axes = 0x07;
  const auto found =
      SerialChain(cell.robot)
          .inverse(compose(compose(cell.X_BT, tool), inverse(cell.X_FP)), {}, parameters);
  if (found.status != SerialChain::InverseStatus::kSolved) {
    throw std::invalid_argument("the wall arm does not reach its start");
  }
  return found.position;
}

}  // namespace

WallArm::WallArm(const Cell& cell, const Pose& tool) : WallArm(cell, gantry_joints(cell, tool)) {}

WallArm::WallArm(const Cell& cell, const JointVector& joints)
    : cell_(cell), chain_(cell.robot), position_(joints), setpoint_(joints) {}

bool WallArm::prepare(std::int64_t /*now_ns*/) {
  if (state_ == ArmState::kUnconfigured) state_ = ArmState::kDisabled;
  return state_ != ArmState::kFault;
}

Pose WallArm::tool() const {
  return compose(compose(inverse(cell_.X_BT), chain_.flange(position_)), cell_.X_FP);
}

Vector3 WallArm::wall_force_N() const {
  Vector3 force_N = Vector3::Zero();
  const Vector3 tip_m = tool().position_m;
  for (const Wall& wall : walls) {
    const double depth_m = wall.sign * (tip_m[wall.axis] - wall.position_m);
    if (depth_m > 0.0) force_N[wall.axis] -= wall.sign * stiffness_Npm * depth_m;
  }
  return force_N;
}

Vector6 WallArm::sensor_reading() {
  const Eigen::Quaterniond R_BS = chain_.flange(position_).orientation * cell_.X_FS.orientation;
  const Eigen::Quaterniond R_ST = R_BS.conjugate() * cell_.X_BT.orientation;
  const Pose X_SP = compose(inverse(cell_.X_FS), cell_.X_FP);
  const Vector3 force_N = R_ST * Vector3(wall_force_N() + push.head<3>());
  const Vector3 torque_Nm = R_ST * Vector3(push.tail<3>());
  const Vector3 weight_N = R_BS.conjugate() * Vector3(0, 0, -kFall_mps2 * cell_.payload_mass_kg);
  Vector6 reading;
  reading << force_N + weight_N,
      torque_Nm + X_SP.position_m.cross(force_N) + cell_.payload_com_m.cross(weight_N);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (int axis = 0; axis < 6; ++axis) {
    reading[axis] += bias[axis] + (axis < 3 ? 1.0 : 1e-3) * noise_N * noise(random_);
  }
  return reading;
}

void WallArm::follow_request() {
  if (break_with.kind != ArmFaultKind::kNone) {
    fault_ = break_with;
    state_ = ArmState::kFault;
    return;
  }
  const auto turn_to = [&](ArmState on_the_way, ArmState there, bool never) {
    if (state_ == there) return;
    if (state_ != on_the_way) {
      state_ = on_the_way;
      cycles_to_go_ = kTransitionCycles;
    }
    if (--cycles_to_go_ <= 0 && !never) state_ = there;
  };
  switch (request_) {
    case ArmRequest::kEnabled:
      return turn_to(ArmState::kEnabling, ArmState::kEnabled, never_enables);
    case ArmRequest::kQuickStop:
      state_ = ArmState::kStopping;
      return;
    case ArmRequest::kDisabled:
      return turn_to(ArmState::kStopping, ArmState::kDisabled, never_disables);
  }
}

void WallArm::start_cycle(std::int64_t now_ns) noexcept {
  if (state_ == ArmState::kEnabled) position_ = setpoint_;
  if (state_ == ArmState::kDisabled) position_[0] += creep_mps * 1e-6 * cell_.robot.cycle_us;
  if (state_ != ArmState::kDisabled) position_[0] += drift_mps * 1e-6 * cell_.robot.cycle_us;
  follow_request();
  answer_ = current_;
  current_.sync_ns = now_ns;
  current_.position = position_;
  current_.wrench = sensor_reading();
  current_.wrench_counter = ++counter_;
}

bool WallArm::receive(std::int64_t /*now_ns*/, ArmFeedback& feedback) noexcept {
  feedback = answer_;
  const bool answered = answer_.wrench_counter != 0;
  feedback.joints_fresh = answered ? all_joints() & ~mute_joints : 0U;
  feedback.wrench_fresh = answered && !mute_sensor;
  feedback.state = state_;
  feedback.fault = fault_;
  return feedback.joints_fresh == all_joints() && feedback.wrench_fresh;
}

void WallArm::command(std::int64_t /*now_ns*/, ArmRequest request,
                      const JointVector& position) noexcept {
  if (request == ArmRequest::kQuickStop && request_ != request) ++quick_stops_;
  request_ = request;
  setpoint_ = position;
}

}  // namespace tenon::executor
