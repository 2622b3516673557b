#include "executor/controller.h"

#include <algorithm>
#include <cmath>

#include "executor/joint_difference.h"
#include "shared/base/error.h"

namespace tenon::executor {
namespace {

constexpr double kNanosecond_s = 1e-9;
// Samples above the on-threshold that make a contact during the approach.
constexpr int kTouchSamples = 2;
// Drives are at rest when no joint has moved further than this for so many cycles.
constexpr double kRestMotion = 2e-5;
constexpr int kRestCycles = 20;

const Plan& with_steps(const Plan& plan) {
  if (plan.steps.empty()) throw InputError("plan '" + plan.task_name + "' has no steps");
  return plan;
}

}  // namespace

Controller::Controller(const Cell& cell, const DryRun& dry_run, const Parameters& parameters)
    : cell_(cell),
      plan_(with_steps(dry_run.plan)),
      start_(dry_run.start),
      parameters_(parameters),
      cycle_s_(1e-6 * cell.robot.cycle_us),
      cycle_ns_(std::int64_t{1000} * cell.robot.cycle_us),
      kinematics_(cell_),
      supervision_(cell_, kinematics_, parameters.supervision),
      admittance_(plan_.compliance, cycle_s_),
      runner_(plan_),
      sensor_tare_(SensorTare::parameters_for(cell.robot.sensor, parameters.tare_samples)),
      joints_(cell_.robot, kinematics_) {}

Controller::Command Controller::cycle(std::int64_t now_ns, const ArmFeedback& feedback) noexcept {
  motion_ns_ += cycle_ns_;
  record_.moving = false;
  record_.move_started = false;
  if (const auto ending = supervision_.update(feedback, following())) end(*ending);
  if (stop_requested_) end({.reason = EndReason::kStopRequested});
  act(feedback);
  move_tool();
  const Command command{request(), joints_.position()};
  write_record(now_ns, feedback, command);
  return command;
}

void Controller::report_overruns(std::uint64_t late_cycles) noexcept {
  end({.reason = EndReason::kOverruns, .value = static_cast<double>(late_cycles)});
}

void Controller::report_poor_feedback(std::uint64_t incomplete_cycles) noexcept {
  end({.reason = EndReason::kFeedbackPoor, .value = static_cast<double>(incomplete_cycles)});
}

// --- states ---------------------------------------------------------------------------------

void Controller::process_event(Event event) {
  const State next = next_state(state_, event);
  if (next != state_) enter_state(next);
}

void Controller::enter_state(State state) {
  state_ = state;
  state_since_ns_ = motion_ns_;
  switch (state) {
    case State::kTaring:
      joints_.rest_at(supervision_.joints());
      commanded_ = supervision_.tool();
      tare_low_ = tare_high_ = supervision_.joints();
      return;
    case State::kApproaching:
      return start_approach();
    case State::kRunning:
      setpoint_ = {commanded_, Vector6::Zero(), Vector6::Zero()};
      admittance_.reset(commanded_);
      return;
    case State::kStopping:
      stop_ = StopProfile(setpoint_, parameters_of_step().speeds);
      return;
    case State::kQuickStopping:
      rest_at_ = supervision_.joints();
      rest_cycles_ = 0;
      return;
    case State::kHolding:
      setpoint_.velocity.setZero();
      setpoint_.acceleration.setZero();
      return;
    case State::kWaiting:
    case State::kDisabling:
    case State::kFinished:
      return;
  }
}

void Controller::end(const Ending& ending) {
  const EndManner manner = end_manner(ending.reason);
  const bool fault = manner == EndManner::kQuickStop;
  const bool first = ending_.reason == EndReason::kNone;
  const bool worse =
      fault && end_manner(ending_.reason) != EndManner::kQuickStop && state_ < State::kDisabling;
  if (first || worse) ending_ = ending;
  if (manner == EndManner::kJointRamp || state_ == State::kApproaching) leave_the_tool();
  if (ending.reason == EndReason::kPlanDone || ending.reason == EndReason::kPlanFailed) {
    return process_event(Event::kPlanEnded);
  }
  process_event(fault ? Event::kFault : Event::kStop);
}

bool Controller::following() const {
  return state_ > State::kWaiting && state_ < State::kDisabling && state_ != State::kQuickStopping;
}

double Controller::time_in_state_s() const {
  return kNanosecond_s * static_cast<double>(motion_ns_ - state_since_ns_);
}

ArmRequest Controller::request() const {
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
    case State::kFinished:
      return ArmRequest::kDisabled;
  }
  return ArmRequest::kDisabled;
}

// --- what a state does ----------------------------------------------------------------------

void Controller::act(const ArmFeedback& feedback) {
  switch (state_) {
    case State::kWaiting:
      if (feedback.state == ArmState::kEnabled && supervision_.known()) {
        return process_event(Event::kEnabled);
      }
      if (time_in_state_s() < parameters_.enable_timeout_s) return;
      return end({.reason = EndReason::kEnableTimeout, .value = time_in_state_s()});
    case State::kTaring:
      return tare(feedback);
    case State::kApproaching:
      return approach();
    case State::kRunning:
      return run_plan();
    case State::kStopping:
      return ramp_down();
    case State::kQuickStopping:
      return wait_for_rest();
    case State::kHolding:
      if (time_in_state_s() >= parameters_.hold_s) process_event(Event::kHeld);
      return;
    case State::kDisabling:
      return wait_for_disabled(feedback);
    case State::kFinished:
      return;
  }
}

void Controller::tare(const ArmFeedback& feedback) {
  for (std::size_t i = 0; i < kinematics_.chain().joint_count(); ++i) {
    tare_low_[i] = std::min(tare_low_[i], supervision_.joints()[i]);
    tare_high_[i] = std::max(tare_high_[i], supervision_.joints()[i]);
    const double moved = tare_high_[i] - tare_low_[i];
    if (moved <= parameters_.tare_motion_max) continue;
    return end({.reason = EndReason::kTareMoving,
                .index = static_cast<int>(i),
                .value = moved,
                .bound = parameters_.tare_motion_max});
  }
  if (!feedback.wrench_fresh) return;
  switch (sensor_tare_.add(feedback.wrench)) {
    case SensorTare::Status::kGathering:
      return;
    case SensorTare::Status::kDone:
      supervision_.tare(sensor_tare_.mean());
      return process_event(Event::kTared);
    case SensorTare::Status::kUnsteady: {
      const int axis = sensor_tare_.worst_axis();
      return end({.reason = EndReason::kTareUnsteady,
                  .index = axis,
                  .value = sensor_tare_.deviation(axis),
                  .bound = sensor_tare_.deviation_max(axis)});
    }
  }
}

// What keeps the plan from starting here: an axis of the tool, or a joint of an arm that holds the
// same tool pose in another way than the dry run did.
std::optional<Ending> Controller::off_start() const {
  const Vector6 off = displacement_between(plan_.start, commanded_);
  for (const int first : {0, 3}) {
    const double bound =
        first == 0 ? parameters_.start_tolerance_m : parameters_.start_tolerance_rad;
    const Vector3 part = off.segment<3>(first);
    if (part.norm() <= bound) continue;
    int worst = 0;
    part.cwiseAbs().maxCoeff(&worst);
    const double wanted = first == 0 ? plan_.start.position_m[worst]
                                     : rotation_vector(plan_.start.orientation)[worst];
    return Ending{.reason = EndReason::kNotAtStart,
                  .index = first + worst,
                  .value = wanted + part[worst],
                  .bound = bound,
                  .wanted = wanted};
  }
  if (!start_) return std::nullopt;
  const JointDifference worst = largest_difference(joints_.position(), *start_);
  if (worst.value <= parameters_.start_tolerance_joint) return std::nullopt;
  const auto joint = static_cast<std::size_t>(worst.joint);
  return Ending{.reason = EndReason::kOtherBranch,
                .index = worst.joint,
                .value = joints_.position()[joint],
                .bound = parameters_.start_tolerance_joint,
                .wanted = (*start_)[joint]};
}

void Controller::start_approach() {
  const std::optional<Ending> off = off_start();
  if (!off) return process_event(Event::kAtStart);
  if (!parameters_.go_to_start || !start_) return end(*off);
  // Within contact speed all the way: its impact is what the plan's check has found harmless.
  approach_ =
      JointMove(joints_.position(), *start_, cell_.robot, kinematics_, parameters_of_step().speeds);
  touch_samples_ = 0;
}

void Controller::approach() {
  const int axis = touching_axis(SerialChain::kAllAxes);
  if (supervision_.wrench_usable()) touch_samples_ = axis < 0 ? 0 : touch_samples_ + 1;
  if (touch_samples_ >= kTouchSamples) {
    return end({.reason = EndReason::kContactOnApproach,
                .index = axis,
                .value = supervision_.wrench()[axis],
                .bound = on_threshold(axis)});
  }
  if (time_in_state_s() >= approach_.duration_s() + parameters_.hold_s) {
    process_event(Event::kAtStart);
  }
}

void Controller::run_plan() {
  GuardedMove::Input input;
  input.time_ns = motion_ns_;
  input.pose = pose_for_move();
  input.wrench = supervision_.wrench();
  input.wrench_fresh = supervision_.wrench_usable();
  const GuardedMove::Output output = runner_.update(input);
  setpoint_ = output.setpoint;
  phase_ = output.phase;
  record_.moving = true;
  record_.move_started = runner_.move_started();
  record_.pose = data_of(input.pose);
  switch (runner_.status()) {
    case PlanRunner::Status::kRunning:
      return;
    case PlanRunner::Status::kDone:
      return end({.reason = EndReason::kPlanDone});
    case PlanRunner::Status::kFailed: {
      const StepReport& last = runner_.report(runner_.report_count() - 1);
      return end({.reason = EndReason::kPlanFailed,
                  .index = static_cast<int>(last.step),
                  .transition = last.transition});
    }
  }
}

void Controller::ramp_down() {
  // Into a contact there is no ramping.
  if (touching_axis(tool_left_ ? SerialChain::kAllAxes : plan_.compliance.compliant_axes) >= 0) {
    yield_here();
    return process_event(Event::kAtRest);
  }
  if (tool_left_) {
    if (joints_.at_rest()) process_event(Event::kAtRest);
    return;
  }
  // The profile begins with the setpoint of the cycle before.
  const double time_s = time_in_state_s() + cycle_s_;
  setpoint_ = stop_.at(time_s);
  if (time_s >= stop_.duration_s()) process_event(Event::kAtRest);
}

void Controller::wait_for_rest() {
  const JointVector& joints = supervision_.joints();
  const bool moved = largest_difference(joints, rest_at_).value > kRestMotion;
  rest_cycles_ = moved ? 0 : rest_cycles_ + 1;
  if (moved) rest_at_ = joints;
  if (rest_cycles_ >= kRestCycles || time_in_state_s() >= parameters_.quick_stop_s) {
    process_event(Event::kAtRest);
  }
}

void Controller::wait_for_disabled(const ArmFeedback& feedback) {
  const bool off =
      feedback.state == ArmState::kDisabled || feedback.state == ArmState::kUnconfigured;
  const double patience_s =
      feedback.state == ArmState::kFault ? parameters_.quick_stop_s : parameters_.disable_timeout_s;
  if (!off && time_in_state_s() < patience_s) return;
  ending_.disable_confirmed = off;
  process_event(Event::kDisabled);
}

// --- giving out -----------------------------------------------------------------------------

// Axes that yield are measured. On the others the tool is where it was told to be: were the
// measured pose taken there, each move would start by a following error off its predecessor's end.
Pose Controller::pose_for_move() const {
  const Pose& commanded = admittance_.state().pose;
  Vector6 off = displacement_between(commanded, supervision_.tool());
  for (int axis = 0; axis < 6; ++axis) {
    if (!admittance_.yields(axis)) off[axis] = 0.0;
  }
  return displaced(commanded, off);
}

double Controller::on_threshold(int axis) const {
  const ContactThresholds& on = parameters_of_step().thresholds;
  return axis < 3 ? on.force_on_N : on.torque_on_Nm;
}

// One of the axes that is above its on-threshold, or -1.
int Controller::touching_axis(std::uint8_t axes) const {
  for (int axis = 0; axis < 6; ++axis) {
    if ((axes >> axis & 1U) == 0) continue;
    if (std::abs(supervision_.wrench()[axis]) > on_threshold(axis)) return axis;
  }
  return -1;
}

// The joints ramp down from where they are.
void Controller::leave_the_tool() {
  if (tool_left_) return;
  tool_left_ = true;
  joints_.stop();
}

// The setpoint is where the tool is, and the tool compliant.
void Controller::yield_here() {
  if (tool_left_) {
    joints_.rest_at(joints_.position());
    admittance_.reset(commanded_);
    tool_left_ = false;
  }
  setpoint_ = {admittance_.state().pose, Vector6::Zero(), Vector6::Zero()};
}

void Controller::move_tool() {
  switch (state_) {
    case State::kApproaching:
    case State::kRunning:
    case State::kStopping:
    case State::kHolding:
      break;
    case State::kWaiting:
      return joints_.rest_at(supervision_.joints());
    case State::kTaring:
    case State::kQuickStopping:
    case State::kDisabling:
    case State::kFinished:
      return supervision_.commanded(Vector6::Zero());
  }
  if (!supervision_.tared()) return;  // a refused tare: hold still, the wrench means nothing
  const bool by_joints = tool_left_ || state_ == State::kApproaching;
  std::optional<Ending> refused;
  if (!by_joints) {
    refused = joints_.follow(admittance_.update(setpoint_, supervision_.wrench()).pose);
  } else if (!tool_left_) {
    refused = joints_.follow(approach_.at(time_in_state_s()));
  }
  if (refused) {
    if (state_ == State::kRunning) refused->step = static_cast<int>(runner_.step());
    end(*refused);
  }
  if (tool_left_) joints_.ramp();

  if (by_joints || tool_left_) {
    commanded_ = kinematics_.tool(joints_.position());
    velocity_ = kinematics_.twist(joints_.position(), joints_.velocity());
    setpoint_ = {commanded_, Vector6::Zero(), Vector6::Zero()};
  } else {
    commanded_ = admittance_.state().pose;
    velocity_ = admittance_.state().velocity;
  }
  supervision_.commanded(velocity_);
}

void Controller::write_record(std::int64_t now_ns, const ArmFeedback& feedback,
                              const Command& command) {
  CycleRecord& r = record_;
  r.sequence = sequence_++;
  r.time_ns = now_ns;
  r.motion_ns = motion_ns_;
  r.state = state_;
  r.arm_state = feedback.state;
  r.request = command.request;
  r.end_reason = static_cast<std::uint8_t>(ending_.reason);
  r.wrench_fresh = supervision_.wrench_usable();
  r.phase = phase_;
  r.step = r.moving ? static_cast<std::int32_t>(runner_.step()) : -1;
  r.steps_done = static_cast<std::uint32_t>(runner_.report_count());
  r.signature_before = runner_.signature_before().bits;
  r.signature = runner_.signature().bits;
  if (!r.moving) r.pose = data_of(supervision_.tool());
  r.wrench = data_of(supervision_.wrench());
  r.setpoint = data_of(setpoint_.pose);
  r.commanded = data_of(commanded_);
  r.velocity = data_of(velocity_);
  r.wrench_raw = data_of(feedback.wrench);
  r.position = supervision_.joints();
  r.position_commanded = command.position;
  r.joints_fresh = feedback.joints_fresh;
}

}  // namespace tenon::executor
