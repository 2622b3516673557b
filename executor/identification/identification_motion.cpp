#include "executor/identification/identification_motion.h"

namespace tenon::executor {
namespace {

constexpr double kEnableTimeout_s = 5.0;
constexpr double kQuickStop_s = 0.5;
constexpr double kDisableTimeout_s = 3.0;

}  // namespace

IdentificationMotion::IdentificationMotion(const Cell& cell)
    : cell_(cell),
      cycle_s_(1e-6 * cell.robot.cycle_us),
      kinematics_(cell_),
      supervision_(cell_, kinematics_, {}),
      joints_(cell_.robot, kinematics_) {}

IdentificationMotion::Command IdentificationMotion::cycle(const ArmFeedback& feedback) noexcept {
  in_state_s_ += cycle_s_;
  const bool following = state_ == State::kActive || state_ == State::kStopping;
  if (const auto ended = supervision_.update(feedback, following)) end(*ended);
  if (stop_requested_) end({.reason = EndReason::kStopRequested});
  run_state(feedback);
  supervision_.commanded(following ? kinematics_.twist(joints_.position(), joints_.velocity())
                                   : Vector6(Vector6::Zero()));
  return {request(), state_ == State::kWaiting ? supervision_.joints() : joints_.position()};
}

void IdentificationMotion::enter(State state) {
  state_ = state;
  in_state_s_ = 0.0;
}

void IdentificationMotion::end(const Ending& ending) {
  const bool first = ending_.reason == EndReason::kNone;
  if (first) ending_ = ending;
  switch (state_) {
    case State::kWaiting:
      return enter(State::kDisabling);
    case State::kActive:
    case State::kStopping: {
      const bool quick = end_manner(ending.reason) == EndManner::kQuickStop;
      if (quick) return enter(State::kQuickStopping);
      if (state_ == State::kStopping) return;
      joints_.stop();
      return enter(State::kStopping);
    }
    case State::kQuickStopping:
    case State::kDisabling:
    case State::kFinished:
      return;
  }
}

void IdentificationMotion::run_state(const ArmFeedback& feedback) {
  switch (state_) {
    case State::kWaiting:
      return wait_for_drives(feedback);
    case State::kActive:
      if (act(feedback) && state_ == State::kActive) {
        joints_.stop();
        enter(State::kStopping);
      }
      return;
    case State::kStopping:
      joints_.ramp();
      if (joints_.at_rest()) enter(State::kDisabling);
      return;
    case State::kQuickStopping:
      if (in_state_s_ >= kQuickStop_s) enter(State::kDisabling);
      return;
    case State::kDisabling:
      return wait_for_power_off(feedback);
    case State::kFinished:
      return;
  }
}

void IdentificationMotion::wait_for_drives(const ArmFeedback& feedback) {
  if (feedback.state == ArmState::kEnabled && supervision_.known()) {
    joints_.rest_at(supervision_.joints());
    enter(State::kActive);
    begin();
  } else if (in_state_s_ >= kEnableTimeout_s) {
    end({.reason = EndReason::kEnableTimeout, .value = in_state_s_});
  }
}

void IdentificationMotion::wait_for_power_off(const ArmFeedback& feedback) {
  const bool off =
      feedback.state == ArmState::kDisabled || feedback.state == ArmState::kUnconfigured;
  if (!off && in_state_s_ < kDisableTimeout_s) return;
  ending_.disable_confirmed = off;
  enter(State::kFinished);
}

ArmRequest IdentificationMotion::request() const {
  switch (state_) {
    case State::kWaiting:
    case State::kActive:
    case State::kStopping:
      return ArmRequest::kEnabled;
    case State::kQuickStopping:
      return ArmRequest::kQuickStop;
    case State::kDisabling:
    case State::kFinished:
      return ArmRequest::kDisabled;
  }
  return ArmRequest::kDisabled;
}

}  // namespace tenon::executor
