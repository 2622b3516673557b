#include "executor/sensing/brake_watch.h"

#include <algorithm>
#include <cmath>

#include "executor/faults/fault_bounds.h"

namespace tenon::executor {
namespace {

// Half of what is watched in any case.
constexpr double kWindow_s = 0.5 * kBrakeWatch_s;
// Either end of a window may be rounded.
constexpr double kWindowRounded_counts = 2.0;

}  // namespace

BrakeWatch::BrakeWatch(const Robot& robot, const Parameters& parameters)
    : joint_count_(robot.joints.size()),
      window_cycles_(static_cast<int>(std::floor(1e6 * kWindow_s / robot.cycle_us))),
      catching_up_(std::min(1.0, 1e-6 * robot.cycle_us / parameters.roll_out_s)) {
  for (std::size_t i = 0; i < joint_count_; ++i) {
    const bool turns = robot.joints[i].kind == Joint::Kind::kRevolute;
    joints_[i].play = turns ? parameters.play_rad : parameters.play_m;
    const double counts = std::abs(robot.joints[i].counts_per_unit);
    joints_[i].creep = std::max(joints_[i].play * kWindow_s / parameters.creep_s,
                                counts > 0.0 ? kWindowRounded_counts / counts : 0.0);
  }
}

void BrakeWatch::update(const JointVector& measured, std::uint32_t fresh, std::uint32_t off) {
  for (std::size_t i = 0; i < joint_count_; ++i) {
    const bool answered = (fresh >> i & 1U) != 0;
    joints_[i].silent_cycles = answered ? 0 : joints_[i].silent_cycles + 1;
    if (answered) take(joints_[i], measured[i], (off >> i & 1U) != 0);
    if (joints_[i].off) watch_creep(joints_[i]);
  }
}

void BrakeWatch::shift(int joint, double by) {
  JointWatch& shifted = joints_[static_cast<std::size_t>(joint)];
  shifted.off_at += by;
  shifted.trailing += by;
  shifted.window_from += by;
}

void BrakeWatch::take(JointWatch& joint, double position, bool off) const {
  if (!joint.known) joint.trailing = position;
  joint.trailing += catching_up_ * (position - joint.trailing);
  if (off && !joint.off) {
    joint.off_at = position;
    joint.bound = joint.play + std::abs(position - joint.trailing);
    joint.window_from = position;
    joint.window_way = 0.0;
    joint.window_cycles = 0;
    joint.creeps = false;
  }
  joint.position = position;
  joint.off = off;
  joint.known = true;
}

void BrakeWatch::watch_creep(JointWatch& joint) const {
  if (++joint.window_cycles <= window_cycles_) return;
  const double way = joint.position - joint.window_from;
  const double share = joint.window_way != 0.0 ? way / joint.window_way : 0.0;
  joint.creeps = std::abs(way) > joint.creep && share > 0.5;
  joint.window_from = joint.position;
  joint.window_way = way;
  joint.window_cycles = 1;
}

bool BrakeWatch::creeps() const {
  for (std::size_t i = 0; i < joint_count_; ++i) {
    if (joints_[i].off && joints_[i].creeps) return true;
  }
  return false;
}

std::optional<BrakeSlip> BrakeWatch::slip() const {
  for (std::size_t i = 0; i < joint_count_; ++i) {
    const JointWatch& joint = joints_[i];
    const double moved = std::abs(joint.position - joint.off_at);
    if (!joint.off || moved <= joint.bound) continue;
    return BrakeSlip{static_cast<int>(i), moved, joint.bound};
  }
  return std::nullopt;
}

std::uint32_t BrakeWatch::unwatched() const {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < joint_count_; ++i) {
    const bool watched = joints_[i].off && joints_[i].silent_cycles <= kFeedbackMissesMax;
    if (!watched) bits |= 1U << i;
  }
  return bits;
}

}  // namespace tenon::executor
