#include "executor/loop/control_task.h"

#include <algorithm>
#include <cmath>

#include "executor/motion/joint_difference.h"
#include "shared/base/time_units.h"

namespace tenon::executor {
namespace {

// Drives are at rest when no joint has moved further than this for so many cycles.
constexpr double kRestMotion = 2e-5;
constexpr int kRestCycles = 20;

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
  if (cell.joint_torque) joint_torque_.emplace(cell);
  parameters_.quick_stop_s = std::max(parameters_.quick_stop_s, time_to_rest_s(cell_.robot));
}

ControlTask::Command ControlTask::cycle(std::int64_t now_ns, const ArmFeedback& heard) noexcept {
  motion_ns_ += cycle_ns_;
  ArmFeedback feedback = heard;
  if (joint_torque_) joint_torque_->feel(feedback);
  if (const auto ending = supervision_.update(feedback, following())) take(*ending);
  follow_brakes(feedback);
  if (stop_requested_) take(Ending{.reason = EndReason::kStopRequested});
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

void ControlTask::report_overruns(std::uint64_t late_cycles) noexcept {
  if (state_ >= State::kDisabling) return;  // nothing is commanded any more
  take(Ending{.reason = EndReason::kOverruns, .value = static_cast<double>(late_cycles)});
}

void ControlTask::report_poor_feedback(std::uint64_t incomplete_cycles) noexcept {
  if (state_ >= State::kDisabling) return;
  take(Ending{.reason = EndReason::kFeedbackPoor, .value = static_cast<double>(incomplete_cycles)});
}

ForceLimit ControlTask::force_limit() const noexcept {
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
  const bool revealed = ending.reason == EndReason::kZeroMoved;
  if (first || worse || revealed) {
    const Ending before = ending_;
    ending_ = ending;
    ending_.disable_confirmed = before.disable_confirmed;
    ending_.brakes_unwatched = before.brakes_unwatched;
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

// --- what a state does ----------------------------------------------------------------------

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
      return watch_brakes();
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
    drift_watch_.restart();
    drift_.reset();
    return {};
  }
  const Vector6& mean = sensor_tare_.mean();
  const Vector6 zero = joint_torque_ ? joint_torque_->settle(mean) : mean;
  if (const auto pushed = supervision_.tare(zero)) return *pushed;
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

// After every end, and each for itself: one drive that is still on, or silent, hides no other's.
ControlTask::Turn ControlTask::watch_brakes() {
  // Without brakes there is nothing to watch: the arm falls, as its cell allows. Nor where a run
  // was stopped before it asked for power: no brake has opened.
  if (!cell_.robot.brakes || !power_asked_) return Event::kHeld;
  const bool told = ending_.slip.joint >= 0;
  if (!told && time_in_state_s() < parameters_.brake_watch_s) {
    const auto slip = brake_watch_.slip();
    if (!slip) return {};
    return Ending{.reason = EndReason::kBrakeFailed,
                  .index = slip->joint,
                  .value = slip->moved,
                  .bound = slip->bound};
  }
  ending_.brakes_unwatched = brake_watch_.unwatched();
  return Event::kHeld;
}

// Until the user has something under the arm, and says so. An arm in a fault holds nothing, however
// long one waits.
ControlTask::Turn ControlTask::keep_power(const ArmFeedback& feedback) const {
  const bool holds = cell_.hold_if_brake_fails && feedback.state != ArmState::kFault;
  return holds ? Turn() : Turn(Event::kStop);
}

std::uint32_t ControlTask::all_joints() const { return (1U << cell_.robot.joints.size()) - 1U; }

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
