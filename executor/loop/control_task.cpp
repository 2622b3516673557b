#include "executor/loop/control_task.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "shared/base/time_units.h"

namespace tenon::executor {
namespace {

// What the slowest joint needs from its full speed, by the deceleration that its drive is told.
double time_to_rest_s(const Robot& robot) {
  constexpr double kMargin_s = 0.1;
  double longest_s = 0.0;
  for (const Joint& joint : robot.joints) {
    longest_s = std::max(longest_s, joint.speed_max / joint.acceleration_max);
  }
  return longest_s + robot.response_lag_s + kMargin_s;
}

// The tare's halves make the means.
DriftWatch::Parameters drift_parameters(const ForceTorqueSensor& sensor, const SensorTare& tare,
                                        int tare_samples) {
  return {.samples = std::max(1, tare_samples / 2),
          .force_deviation_N = tare.deviation_max(0),
          .torque_deviation_Nm = tare.deviation_max(3),
          .force_per_count_N = sensor.force_per_count_N,
          .torque_per_count_Nm = sensor.torque_per_count_Nm};
}

// The task has done what it could, and stands.
bool came_to_its_end(EndReason reason) {
  return reason == EndReason::kPlanDone || reason == EndReason::kPlanFailed ||
         reason == EndReason::kMeasured || reason == EndReason::kNothingMet ||
         reason == EndReason::kNotAtGoal;
}

// Nothing else went wrong: what a brake does is then the run's name.
bool went_well(EndReason reason) {
  return reason == EndReason::kPlanDone || reason == EndReason::kMeasured ||
         reason == EndReason::kNothingMet || reason == EndReason::kStopRequested;
}

}  // namespace

ControlTask::ControlTask(const Cell& cell, const Parameters& parameters)
    : cell_(sensed_cell(cell)),
      parameters_(parameters),
      cycle_s_(1e-6 * cell.robot.cycle_us),
      cycle_ns_(std::int64_t{1000} * cell.robot.cycle_us),
      kinematics_(cell_),
      supervision_(cell_, kinematics_, parameters.supervision),
      sensor_tare_(SensorTare::parameters_for(cell.robot.sensor, parameters.tare_samples)),
      drift_watch_(drift_parameters(cell.robot.sensor, sensor_tare_, parameters.tare_samples)),
      brake_watch_(cell_.robot, parameters.brakes),
      joints_(cell_.robot, kinematics_) {
  if (cell.joint_torque) {
    joint_torque_.emplace(cell);
    effort_watch_.emplace(cell);
  }
  parameters_.quick_stop_s = std::max(parameters_.quick_stop_s, time_to_rest_s(cell_.robot));
}

ControlTask::Command ControlTask::cycle(std::int64_t now_ns, const ArmFeedback& heard) noexcept {
  motion_ns_ += cycle_ns_;
  ArmFeedback feedback = heard;
  if (joint_torque_) joint_torque_->feel(feedback);
  // First: what it leads to is felt and seen as well.
  if (effort_watch_) watch_efforts(feedback);
  if (const auto ending = supervision_.update(feedback, following())) {
    // An encoder that jumps is no joint that slips.
    if (ending->reason == EndReason::kEncoderJump) brake_watch_.shift(ending->index, ending->value);
    take(*ending);
  }
  follow_brakes(feedback);
  take_requests();
  take(act(feedback));
  const bool about_to_enable = state_ == State::kWaiting || state_ == State::kCatching;
  if (about_to_enable && feedback.state != ArmState::kEnabled)
    joints_.rest_at(supervision_.joints());
  Vector6 velocity = Vector6::Zero();
  if (moving()) {
    if (const auto refused = command_joints()) take(*refused);
    velocity = complete_motion();
  }
  supervision_.commanded(velocity, joints_.position());
  record_.velocity = data_of(velocity);
  const Command command{request(), joints_.position()};
  power_asked_ = power_asked_ || command.request == ArmRequest::kEnabled;
  write_record(now_ns, feedback, command);
  return command;
}

void ControlTask::watch_efforts(const ArmFeedback& feedback) {
  if (!following()) return effort_watch_->let_go();
  if (!feedback.wrench_fresh) return;  // a joint has not answered
  const auto frozen =
      effort_watch_->update(feedback, joints_.position(), joint_torque_->external());
  if (!frozen) return;
  take(Ending{.reason = EndReason::kEffortFrozen,
              .index = frozen->joint,
              .value = static_cast<double>(frozen->cycles)});
}

// An arm that is held falls where nobody has something under it: that is for the user to say.
void ControlTask::take_requests() {
  const bool holding = state_ == State::kCatching && cell_.hold_if_brake_fails;
  const bool ended = std::exchange(end_requested_, false);
  if (ended && holding) ++stops_unheeded_;
  if (std::exchange(stop_requested_, false) || (ended && !holding)) {
    take(Ending{.reason = EndReason::kStopRequested});
  }
}

void ControlTask::report_overruns(std::uint64_t late_cycles) noexcept {
  if (state_ >= State::kDisabling) return;  // nothing is commanded any more
  take(Ending{.reason = EndReason::kOverruns, .value = static_cast<double>(late_cycles)});
}

void ControlTask::report_poor_feedback(std::uint64_t incomplete_cycles) noexcept {
  if (state_ >= State::kDisabling) return;
  take(Ending{.reason = EndReason::kFeedbackPoor, .value = static_cast<double>(incomplete_cycles)});
}

ForceLimit ControlTask::force_limit() const noexcept {
  if (state_ >= State::kDisabling) return {};
  if (parameters_.masked.masks(EndReason::kForceFault, ArmFaultKind::kNone)) return {};
  return supervision_.force_limit();
}

// --- states ---------------------------------------------------------------------------------

// Every change of state is made here. A state can be over as it begins.
void ControlTask::take(const Turn& turn) {
  std::optional<Event> event = event_of(turn);
  while (event) {
    const State next = next_state(state_, *event);
    if (next == state_) return;
    event = event_of(enter_state(next));
  }
}

std::optional<Event> ControlTask::event_of(const Turn& turn) {
  if (const auto* event = std::get_if<Event>(&turn)) return *event;
  const auto* ending = std::get_if<Ending>(&turn);
  if (ending == nullptr || parameters_.masked.masks(ending->reason, ending->arm_fault.kind)) {
    return std::nullopt;
  }
  return remember(*ending);
}

ControlTask::Turn ControlTask::enter_state(State state) {
  state_ = state;
  state_since_ns_ = motion_ns_;
  if (state == State::kTaring) {
    joints_.rest_at(supervision_.joints());
    tare_low_ = tare_high_ = supervision_.joints();
    if (effort_watch_) effort_watch_->begin_tare();
  }
  if (state == State::kQuickStopping) {
    rest_at_ = supervision_.joints();
    rest_cycles_ = 0;
  }
  return on_enter(state);
}

// A fault takes precedence over an orderly end, and what the end reveals over that the plan is
// done; else the first stays. What was seen of the drives after it stays with either.
Event ControlTask::remember(const Ending& ending) {
  on_ending(ending);
  const bool fault = end_manner(ending.reason) == EndManner::kQuickStop;
  const bool first = ending_.reason == EndReason::kNone;
  const bool slipped = ending.reason == EndReason::kBrakeFailed;
  // Once the power goes, a fault takes the name of a run that went well, and leaves it to one that
  // somebody had stopped.
  const bool asked = ending_.reason == EndReason::kStopRequested;
  bool worse = fault && end_manner(ending_.reason) != EndManner::kQuickStop;
  if (state_ >= State::kDisabling) worse = fault && went_well(ending_.reason) && !asked;
  if (slipped) worse = went_well(ending_.reason);
  const bool revealed =
      ending.reason == EndReason::kZeroMoved || ending.reason == EndReason::kNotHeld;
  if (first || worse || revealed) {
    const Ending before = ending_;
    ending_ = ending;
    ending_.disable_confirmed = before.disable_confirmed;
    ending_.brakes_unwatched = before.brakes_unwatched;
    ending_.hold = before.hold;
  }
  if (slipped) ending_.slip = {ending.index, ending.value, ending.bound};
  if (came_to_its_end(ending.reason)) return Event::kWorkEnded;
  if (slipped) return Event::kBrakeFailed;
  return fault ? Event::kFault : Event::kStop;
}

bool ControlTask::following() const {
  return state_ > State::kWaiting && state_ < State::kDisabling && state_ != State::kQuickStopping;
}

// After a refused tare the arm holds still: the wrench means nothing.
bool ControlTask::moving() const {
  return following() && state_ != State::kTaring && supervision_.tared();
}

double ControlTask::time_in_state_s() const {
  return kNanosecond_s * static_cast<double>(motion_ns_ - state_since_ns_);
}

ArmRequest ControlTask::request() const {
  switch (state_) {
    case State::kWaiting:
    case State::kTaring:
    case State::kApproaching:
    case State::kRunning:
    case State::kStopping:
    case State::kHolding:
      return ArmRequest::kEnabled;
    case State::kQuickStopping:
      return ArmRequest::kQuickStop;
    case State::kDisabling:
    case State::kWatching:
    case State::kFinished:
      return ArmRequest::kDisabled;
    case State::kCatching:
      return cell_.hold_if_brake_fails ? ArmRequest::kEnabled : ArmRequest::kDisabled;
  }
  return ArmRequest::kDisabled;
}

void ControlTask::write_record(std::int64_t now_ns, const ArmFeedback& feedback,
                               const Command& command) {
  CycleRecord& r = record_;
  r.sequence = sequence_++;
  r.time_ns = now_ns;
  r.motion_ns = motion_ns_;
  r.state = state_;
  r.arm_state = feedback.state;
  r.request = command.request;
  r.end_reason = static_cast<std::uint8_t>(ending_.reason);
  r.arm_fault = ending_.arm_fault;
  r.slip = ending_.slip;
  r.hold = ending_.hold;
  r.stops_unheeded = stops_unheeded_;
  r.brakes_unwatched = ending_.brakes_unwatched;
  r.wrench_fresh = supervision_.wrench_usable();
  r.pose = data_of(supervision_.tool());
  r.wrench = data_of(supervision_.wrench());
  r.wrench_raw = data_of(feedback.wrench);
  r.position = supervision_.joints();
  r.position_commanded = command.position;
  r.joints_fresh = feedback.joints_fresh;
  write_motion(r);
}

}  // namespace tenon::executor
