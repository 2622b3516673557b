// What each state of a task does, from waiting for the drives to seeing their brakes hold.

#include <algorithm>

#include "executor/loop/control_task.h"
#include "executor/motion/joint_difference.h"

namespace tenon::executor {
namespace {

// Drives are at rest when no joint has moved further than this for so many cycles.
constexpr double kRestMotion = 2e-5;
constexpr int kRestCycles = 20;

}  // namespace

ControlTask::Turn ControlTask::act(const ArmFeedback& feedback) {
  switch (state_) {
    case State::kWaiting:
      return wait_for_drives(feedback);
    case State::kTaring:
      return tare(feedback);
    case State::kApproaching:
      return approach();
    case State::kRunning:
      return run(feedback);
    case State::kStopping:
      return ramp_down();
    case State::kQuickStopping:
      return wait_for_rest(feedback);
    case State::kHolding:
      return hold();
    case State::kDisabling:
      return wait_for_disabled(feedback);
    case State::kWatching:
      return watch_brakes(feedback);
    case State::kCatching:
      return keep_power(feedback);
    case State::kFinished:
      return {};
  }
  return {};
}

ControlTask::Turn ControlTask::held() const {
  return time_in_state_s() >= parameters_.hold_s ? Turn(Event::kHeld) : Turn();
}

ControlTask::Turn ControlTask::wait_for_drives(const ArmFeedback& feedback) const {
  if (feedback.state == ArmState::kEnabled && supervision_.known()) return Event::kEnabled;
  if (time_in_state_s() < parameters_.enable_timeout_s) return {};
  return Ending{.reason = EndReason::kEnableTimeout, .value = time_in_state_s()};
}

ControlTask::Turn ControlTask::tare(const ArmFeedback& feedback) {
  for (std::size_t i = 0; i < cell_.robot.joints.size(); ++i) {
    tare_low_[i] = std::min(tare_low_[i], supervision_.joints()[i]);
    tare_high_[i] = std::max(tare_high_[i], supervision_.joints()[i]);
    const double moved = tare_high_[i] - tare_low_[i];
    if (moved <= parameters_.tare_motion_max) continue;
    return Ending{.reason = EndReason::kTareMoving,
                  .index = static_cast<int>(i),
                  .value = moved,
                  .bound = parameters_.tare_motion_max};
  }
  if (!feedback.wrench_fresh) return {};
  if (!drift_) drift_ = watch_drift(feedback.wrench);
  if (sensor_tare_.add(feedback.wrench) == SensorTare::Status::kGathering) return {};
  return end_tare();
}

ControlTask::Turn ControlTask::end_tare() {
  const bool masked = parameters_.masked.masks(EndReason::kTareDrift, ArmFaultKind::kNone);
  const bool drifts = drift_ && !masked;
  if (drifts || sensor_tare_.status() == SensorTare::Status::kUnsteady) {
    // An arm that has just taken its load off the brakes swings for a while, and one whose joints
    // wind up or whose sensor warms up creeps.
    if (++unsteady_tares_ >= kTareTries) {
      // A zero that moves steadily is unsteady, too: the cause is named and not its effect.
      const bool steadily = drifts && sensor_tare_.deviation_beside_drift(drift_->index) <=
                                          sensor_tare_.deviation_max(drift_->index);
      return steadily ? *drift_ : unsteady(sensor_tare_);
    }
    sensor_tare_.start_again();
    if (effort_watch_) effort_watch_->begin_tare();
    drift_watch_.restart();
    drift_.reset();
    return {};
  }
  const Vector6& mean = sensor_tare_.mean();
  const Vector6 zero = joint_torque_ ? joint_torque_->settle(mean) : mean;
  if (const auto pushed = supervision_.tare(zero)) return *pushed;
  if (effort_watch_) effort_watch_->end_tare();
  drift_watch_.restart();
  return Event::kTared;
}

std::optional<Ending> ControlTask::watch_drift(const Vector6& sample) {
  const auto drift = drift_watch_.add(sample);
  if (!drift) return std::nullopt;
  return Ending{.reason = EndReason::kTareDrift,
                .index = drift->axis,
                .value = drift->moved,
                .bound = drift->bound};
}

std::optional<Ending> ControlTask::wait_in_free_air() {
  if (!supervision_.wrench_usable()) return std::nullopt;
  const std::optional<Ending> drift = watch_drift(supervision_.contact_at_sensor());
  return drift_watch_.began_at_zero() ? drift : std::nullopt;
}

// A joint that does not answer may move.
ControlTask::Turn ControlTask::wait_for_rest(const ArmFeedback& feedback) {
  const JointVector& joints = supervision_.joints();
  const bool moved = feedback.joints_fresh != all_joints() ||
                     largest_difference(joints, rest_at_).value > kRestMotion;
  rest_cycles_ = moved ? 0 : rest_cycles_ + 1;
  if (moved) rest_at_ = joints;
  const bool rested = rest_cycles_ >= kRestCycles || time_in_state_s() >= parameters_.quick_stop_s;
  return rested ? Turn(Event::kAtRest) : Turn();
}

ControlTask::Turn ControlTask::wait_for_disabled(const ArmFeedback& feedback) {
  const bool off =
      joints_off(feedback) == all_joints() || feedback.state == ArmState::kUnconfigured;
  const double patience_s =
      feedback.joints_fresh == 0 ? parameters_.quick_stop_s : parameters_.disable_timeout_s;
  if (!off && time_in_state_s() < patience_s) return {};
  if (!off) name_not_disabled(joints_off(feedback));
  ending_.disable_confirmed = off;
  return Event::kDisabled;
}

// In a fault the arm's state stays one: the drives' own words count. A bus that is gone brings
// none.
std::uint32_t ControlTask::joints_off(const ArmFeedback& feedback) const {
  return feedback.state == ArmState::kDisabled ? all_joints() : feedback.joints_off;
}

void ControlTask::follow_brakes(const ArmFeedback& feedback) {
  brake_watch_.update(supervision_.joints(), feedback.joints_fresh, joints_off(feedback));
}

// Without brakes there is nothing to watch: the arm falls, as its cell allows. Nor where a run was
// stopped before it asked for power: no brake has opened.
bool ControlTask::brakes_under_watch() const { return cell_.robot.brakes && power_asked_; }

// After every end, and each for itself: one drive that is still on, or silent, hides no other's.
ControlTask::Turn ControlTask::watch_brakes(const ArmFeedback& feedback) {
  const bool told = ending_.slip.joint >= 0;
  const double watch_s =
      brake_watch_.creeps() ? parameters_.brake_creep_s : parameters_.brake_watch_s;
  if (brakes_under_watch() && !told && time_in_state_s() < watch_s) {
    const auto slip = brake_watch_.slip();
    if (!slip) return {};
    return Ending{.reason = EndReason::kBrakeFailed,
                  .index = slip->joint,
                  .value = slip->moved,
                  .bound = slip->bound};
  }
  // Somebody else may have switched a drive on again: it is told to go off, as in every cycle.
  const std::uint32_t on = feedback.joints_fresh & ~joints_off(feedback);
  if (on != 0 && ending_.disable_confirmed) {
    if (time_in_state_s() < parameters_.brake_watch_s + parameters_.disable_timeout_s) return {};
    name_not_disabled(~on);
    ending_.disable_confirmed = false;
  }
  if (brakes_under_watch()) {
    name_unseen();
    if (const auto seen = seen_in_brakes()) (void)event_of(*seen);
  }
  return Event::kHeld;
}

// A run that went well is none that did if nobody knows whether its brakes hold.
void ControlTask::name_unseen() {
  ending_.brakes_unwatched = brake_watch_.unwatched();
  for (std::size_t i = 0; i < cell_.robot.joints.size(); ++i) {
    const int silent = brake_watch_.silent_cycles(i);
    if (silent <= kFeedbackMissesMax) continue;
    (void)event_of(Ending{.reason = EndReason::kFeedbackMissing,
                          .index = static_cast<int>(i),
                          .value = static_cast<double>(silent),
                          .bound = static_cast<double>(kFeedbackMissesMax)});
    return;
  }
}

// @param off bit i: joint i has said that its drive is off
void ControlTask::name_not_disabled(std::uint32_t off) {
  for (std::size_t i = 0; i < cell_.robot.joints.size(); ++i) {
    if ((off >> i & 1U) != 0) continue;
    (void)event_of(Ending{.reason = EndReason::kNotDisabled,
                          .index = static_cast<int>(i),
                          .value = time_in_state_s()});
    return;
  }
}

// Until the user has something under the arm, and says so. An arm in a fault holds nothing, however
// long one waits, nor does one whose drives do not come on.
ControlTask::Turn ControlTask::keep_power(const ArmFeedback& feedback) {
  if (!cell_.hold_if_brake_fails) return Event::kStop;
  const bool on = feedback.state == ArmState::kEnabled;
  if (on) ending_.hold = Hold::kHeld;
  const bool held = ending_.hold == Hold::kHeld;
  const bool too_late = !held && time_in_state_s() >= parameters_.enable_timeout_s;
  if (feedback.state != ArmState::kFault && !too_late && on == held) return {};
  ending_.hold = held ? Hold::kLost : Hold::kRefused;
  if (ending_.arm_fault.kind == ArmFaultKind::kNone) ending_.arm_fault = feedback.fault;
  return Event::kStop;
}

std::uint32_t ControlTask::all_joints() const { return (1U << cell_.robot.joints.size()) - 1U; }

}  // namespace tenon::executor
