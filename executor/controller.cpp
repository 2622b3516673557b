#include "executor/controller.h"

#include <algorithm>
#include <cmath>

#include "shared/base/error.h"

namespace tenon::executor {
namespace {

constexpr double kNanosecond_s = 1e-9;
// Bounds for a sensor whose data sheet is silent about its noise.
constexpr double kForceDeviation_N = 0.05;
constexpr double kTorqueDeviation_Nm = 0.005;
// A resting sensor may be this many times as noisy as its data sheet says.
constexpr double kNoiseFactor = 3.0;
// Samples above the on-threshold that make a contact during the approach.
constexpr int kTouchSamples = 2;
// Drives are at rest when no joint has moved further than this for so many cycles.
constexpr double kRestMotion = 2e-5;
constexpr int kRestCycles = 20;
// Rounding of the commanded position is no excess of speed.
constexpr double kSpeedTolerance = 1.0 + 1e-6;

const Plan& with_steps(const Plan& plan) {
  if (plan.steps.empty()) throw InputError("plan '" + plan.task_name + "' has no steps");
  return plan;
}

SensorTare::Parameters tare_parameters(const ForceTorqueSensor& sensor, int samples) {
  SensorTare::Parameters parameters;
  parameters.samples = samples;
  parameters.force_deviation_max_N =
      std::max({kForceDeviation_N, kNoiseFactor * sensor.force_noise_N, sensor.force_per_count_N});
  parameters.torque_deviation_max_Nm = std::max(
      {kTorqueDeviation_Nm, kNoiseFactor * sensor.torque_noise_Nm, sensor.torque_per_count_Nm});
  return parameters;
}

}  // namespace

Controller::Controller(const Cell& cell, const Plan& plan, const Parameters& parameters)
    : cell_(cell),
      plan_(with_steps(plan)),
      parameters_(parameters),
      cycle_s_(1e-6 * cell.robot.cycle_us),
      cycle_ns_(std::int64_t{1000} * cell.robot.cycle_us),
      kinematics_(cell_),
      wrench_(cell_),
      admittance_(plan_.compliance, cycle_s_),
      runner_(plan_),
      sensor_tare_(tare_parameters(cell.robot.sensor, parameters.tare_samples)) {}

Controller::Command Controller::cycle(std::int64_t now_ns, const ArmFeedback& feedback) noexcept {
  motion_ns_ += cycle_ns_;
  record_.moving = false;
  record_.move_started = false;
  take_joints(feedback);
  take_wrench(feedback);
  watch_arm(feedback);
  watch_force(feedback);
  if (stop_requested_) end({.reason = EndReason::kStopRequested});
  act(feedback);
  move_tool();
  const Command command{request(), joints_};
  write_record(now_ns, feedback, command);
  return command;
}

void Controller::report_overruns(std::uint64_t late_cycles) noexcept {
  end({.reason = EndReason::kOverruns, .value = static_cast<double>(late_cycles)});
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
      joints_ = measured_;
      commanded_ = tool_;
      tare_low_ = measured_;
      tare_high_ = measured_;
      return;
    case State::kApproaching:
      setpoint_ = {commanded_, Vector6::Zero(), Vector6::Zero()};
      admittance_.reset(commanded_);
      return start_approach();
    case State::kStopping:
      stop_ = StopProfile(setpoint_, parameters_of_step().speeds);
      return;
    case State::kQuickStopping:
      rest_at_ = measured_;
      rest_cycles_ = 0;
      return;
    case State::kHolding:
      setpoint_.velocity.setZero();
      setpoint_.acceleration.setZero();
      return;
    case State::kWaiting:
    case State::kRunning:
    case State::kDisabling:
    case State::kFinished:
      return;
  }
}

void Controller::end(const Ending& ending) {
  const bool fault = wants_quick_stop(ending.reason);
  const bool first = ending_.reason == EndReason::kNone;
  const bool worse = fault && !wants_quick_stop(ending_.reason) && state_ < State::kDisabling;
  if (first || worse) ending_ = ending;
  if (ending.reason == EndReason::kPlanDone || ending.reason == EndReason::kPlanFailed) {
    return process_event(Event::kPlanEnded);
  }
  process_event(fault ? Event::kFault : Event::kStop);
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

// --- taking in ------------------------------------------------------------------------------

void Controller::take_joints(const ArmFeedback& feedback) {
  bool all = true;
  for (std::size_t i = 0; i < kinematics_.chain().joint_count(); ++i) {
    const bool fresh =
        (feedback.joints_fresh >> i & 1U) != 0 && std::isfinite(feedback.position[i]);
    all = all && fresh;
    misses_[i] = fresh ? 0 : misses_[i] + 1;
    if (fresh) measured_[i] = feedback.position[i];
  }
  known_ = known_ || all;
  if (known_) tool_ = kinematics_.tool(measured_);
}

void Controller::take_wrench(const ArmFeedback& feedback) {
  wrench_age_ns_ = feedback.wrench_fresh ? 0 : wrench_age_ns_ + cycle_ns_;
  wrench_usable_ = feedback.wrench_fresh && blind_cycles_ == 0;
  if (blind_cycles_ > 0) --blind_cycles_;
  if (!feedback.wrench_fresh || !known_) return;
  switch (wrench_.update(feedback.wrench, tool_)) {
    case WrenchEstimator::Status::kGood:
      return;
    case WrenchEstimator::Status::kSaturated: {
      const int axis = wrench_.axis();
      const ForceTorqueSensor& sensor = cell_.robot.sensor;
      return end({.reason = EndReason::kSensorSaturated,
                  .index = axis,
                  .value = feedback.wrench[axis],
                  .bound = axis < 3 ? sensor.force_range_N : sensor.torque_range_Nm});
    }
    case WrenchEstimator::Status::kNotFinite:
      return end({.reason = EndReason::kSensorNotFinite});
  }
}

void Controller::watch_arm(const ArmFeedback& feedback) {
  if (feedback.state == ArmState::kFault) {
    return end({.reason = EndReason::kArmFault, .arm_fault = feedback.fault});
  }
  const bool following =
      state_ > State::kWaiting && state_ < State::kDisabling && state_ != State::kQuickStopping;
  if (!following) return;
  if (feedback.state != ArmState::kEnabled) {
    return end({.reason = EndReason::kArmNotEnabled, .index = static_cast<int>(feedback.state)});
  }
  for (std::size_t i = 0; i < kinematics_.chain().joint_count(); ++i) {
    if (misses_[i] <= parameters_.feedback_misses_max) continue;
    return end({.reason = EndReason::kFeedbackMissing,
                .index = static_cast<int>(i),
                .value = static_cast<double>(misses_[i]),
                .bound = static_cast<double>(parameters_.feedback_misses_max)});
  }
  const double age_s = kNanosecond_s * static_cast<double>(wrench_age_ns_);
  if (age_s > parameters_.wrench_age_max_s) {
    end({.reason = EndReason::kWrenchMissing,
         .value = age_s,
         .bound = parameters_.wrench_age_max_s});
  }
}

void Controller::watch_force(const ArmFeedback& feedback) {
  if (!tared_ || !feedback.wrench_fresh) return;
  const double force_N = wrench_.external().head<3>().norm();
  const double torque_Nm = wrench_.external().tail<3>().norm();
  peak_force_N_ = std::max(peak_force_N_, force_N);
  peak_torque_Nm_ = std::max(peak_torque_Nm_, torque_Nm);
  if (force_N > cell_.force_fault_N) {
    return end({.reason = EndReason::kForceFault, .value = force_N, .bound = cell_.force_fault_N});
  }
  if (torque_Nm > cell_.torque_fault_Nm) {
    end({.reason = EndReason::kTorqueFault, .value = torque_Nm, .bound = cell_.torque_fault_Nm});
  }
}

// --- what a state does ----------------------------------------------------------------------

void Controller::act(const ArmFeedback& feedback) {
  switch (state_) {
    case State::kWaiting:
      if (feedback.state == ArmState::kEnabled && known_) return process_event(Event::kEnabled);
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
    case State::kDisabling: {
      const bool off =
          feedback.state == ArmState::kDisabled || feedback.state == ArmState::kUnconfigured;
      const bool given_up =
          time_in_state_s() >= (feedback.state == ArmState::kFault ? parameters_.quick_stop_s
                                                                   : parameters_.disable_timeout_s);
      if (off || given_up) {
        ending_.disable_confirmed = off;
        process_event(Event::kDisabled);
      }
      return;
    }
    case State::kFinished:
      return;
  }
}

void Controller::tare(const ArmFeedback& feedback) {
  for (std::size_t i = 0; i < kinematics_.chain().joint_count(); ++i) {
    tare_low_[i] = std::min(tare_low_[i], measured_[i]);
    tare_high_[i] = std::max(tare_high_[i], measured_[i]);
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
      wrench_.tare(sensor_tare_.mean(), tool_);
      tared_ = true;
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

void Controller::start_approach() {
  const Vector6 way = displacement_between(commanded_, plan_.start);
  const double distance_m = way.head<3>().norm();
  const double angle_rad = way.tail<3>().norm();
  if (distance_m <= parameters_.start_tolerance_m && angle_rad <= parameters_.start_tolerance_rad) {
    return process_event(Event::kAtStart);
  }
  if (!parameters_.go_to_start) {
    const bool linear = distance_m > parameters_.start_tolerance_m;
    return end({.reason = EndReason::kNotAtStart,
                .index = linear ? 0 : 3,
                .value = linear ? distance_m : angle_rad,
                .bound = linear ? parameters_.start_tolerance_m : parameters_.start_tolerance_rad});
  }
  // At contact speed all the way: the speed whose impact the plan's check has found harmless.
  const SpeedLimits& v = parameters_of_step().speeds;
  const double length = std::max(distance_m, angle_rad * v.contact_mps / v.contact_radps);
  const double radians_per_path = angle_rad / length;
  const auto limit = [&](double linear, double angular) {
    return radians_per_path > 0.0 ? std::min(linear, angular / radians_per_path) : linear;
  };
  MotionProfile::Parameters p;
  p.length = length;
  p.fast_speed = p.slow_speed = limit(v.contact_mps, v.contact_radps);
  p.acceleration = limit(v.acceleration_mps2, v.acceleration_radps2);
  p.jerk = limit(v.jerk_mps3, v.jerk_radps3);
  approach_ = MotionProfile(p);
  approach_from_ = commanded_;
  approach_along_ = way / length;
  touch_samples_ = 0;
}

void Controller::approach() {
  const int axis = touching_axis();
  if (wrench_usable_) touch_samples_ = axis < 0 ? 0 : touch_samples_ + 1;
  if (touch_samples_ >= kTouchSamples) {
    const ContactThresholds& on = parameters_of_step().thresholds;
    return end({.reason = EndReason::kContactOnApproach,
                .index = axis,
                .value = wrench_.external()[axis],
                .bound = axis < 3 ? on.force_on_N : on.torque_on_Nm});
  }
  const MotionProfile::Sample sample = approach_.at(time_in_state_s());
  setpoint_.pose = displaced(approach_from_, approach_along_ * sample.position);
  setpoint_.velocity = approach_along_ * sample.velocity;
  setpoint_.acceleration = approach_along_ * sample.acceleration;
  if (time_in_state_s() >= approach_.duration_s() + parameters_.hold_s) {
    process_event(Event::kAtStart);
  }
}

void Controller::run_plan() {
  GuardedMove::Input input;
  input.time_ns = motion_ns_;
  input.pose = pose_for_move();
  input.wrench = wrench_.external();
  input.wrench_fresh = wrench_usable_;
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
  // The profile begins with the setpoint of the cycle before.
  const double time_s = time_in_state_s() + cycle_s_;
  setpoint_ = stop_.at(time_s);
  // Into a contact there is no ramping: the setpoint stays where the tool is.
  if (touching_axis() >= 0) stop_setpoint_here();
  if (time_s >= stop_.duration_s()) process_event(Event::kAtRest);
}

void Controller::stop_setpoint_here() {
  setpoint_ = {admittance_.state().pose, Vector6::Zero(), Vector6::Zero()};
  stop_ = StopProfile(setpoint_, {});
}

void Controller::wait_for_rest() {
  bool moved = false;
  for (std::size_t i = 0; i < kinematics_.chain().joint_count(); ++i) {
    moved = moved || std::abs(measured_[i] - rest_at_[i]) > kRestMotion;
  }
  rest_cycles_ = moved ? 0 : rest_cycles_ + 1;
  if (moved) rest_at_ = measured_;
  if (rest_cycles_ >= kRestCycles || time_in_state_s() >= parameters_.quick_stop_s) {
    process_event(Event::kAtRest);
  }
}

// --- giving out -----------------------------------------------------------------------------

// Axes that yield are measured. On the others the tool is where it was told to be: were the
// measured pose taken there, each move would start by a following error off its predecessor's end.
Pose Controller::pose_for_move() const {
  const Pose& commanded = admittance_.state().pose;
  Vector6 off = displacement_between(commanded, tool_);
  for (int axis = 0; axis < 6; ++axis) {
    if (!admittance_.yields(axis)) off[axis] = 0.0;
  }
  return displaced(commanded, off);
}

// A compliant axis above its on-threshold, or -1.
int Controller::touching_axis() const {
  const ContactThresholds& on = parameters_of_step().thresholds;
  for (int axis = 0; axis < 6; ++axis) {
    const double bound = axis < 3 ? on.force_on_N : on.torque_on_Nm;
    if (admittance_.yields(axis) && std::abs(wrench_.external()[axis]) > bound) return axis;
  }
  return -1;
}

void Controller::move_tool() {
  switch (state_) {
    case State::kApproaching:
    case State::kRunning:
    case State::kStopping:
    case State::kHolding:
      break;
    case State::kWaiting:
      joints_ = measured_;
      return;
    case State::kTaring:
    case State::kQuickStopping:
    case State::kDisabling:
    case State::kFinished:
      wrench_.commanded(Vector6::Zero());
      return;
  }
  if (!tared_) return;  // a refused tare: hold still, the wrench means nothing
  const Admittance::State& state = admittance_.update(setpoint_, wrench_.external());
  wrench_.commanded(state.velocity);
  command_joints(state.pose);
}

void Controller::command_joints(const Pose& tool) {
  const SerialChain::Inverse inverse = kinematics_.joints(tool, joints_);
  switch (inverse.status) {
    case SerialChain::InverseStatus::kSolved:
      break;
    case SerialChain::InverseStatus::kJointLimit: {
      const auto i = static_cast<std::size_t>(inverse.joint);
      const bool low = inverse.position[i] <= cell_.robot.joints[i].lower;
      const double bound = low ? cell_.robot.joints[i].lower : cell_.robot.joints[i].upper;
      return end({.reason = EndReason::kJointLimit,
                  .index = inverse.joint,
                  .value = bound + (low ? -inverse.error : inverse.error),
                  .bound = bound});
    }
    case SerialChain::InverseStatus::kNotConverged:
    case SerialChain::InverseStatus::kNotFinite:
      return end({.reason = EndReason::kUnreachable, .value = inverse.error});
  }
  for (std::size_t i = 0; i < kinematics_.chain().joint_count(); ++i) {
    const double speed = std::abs(inverse.position[i] - joints_[i]) / cycle_s_;
    const double most = cell_.robot.joints[i].speed_max;
    if (speed <= most * kSpeedTolerance) continue;
    return end({.reason = EndReason::kJointSpeed,
                .index = static_cast<int>(i),
                .value = speed,
                .bound = most});
  }
  joints_ = inverse.position;
  commanded_ = tool;
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
  r.wrench_fresh = wrench_usable_;
  r.phase = phase_;
  r.step = r.moving ? static_cast<std::int32_t>(runner_.step()) : -1;
  r.steps_done = static_cast<std::uint32_t>(runner_.report_count());
  r.signature_before = runner_.signature_before().bits;
  r.signature = runner_.signature().bits;
  if (!r.moving) r.pose = data_of(tool_);
  r.wrench = data_of(wrench_.external());
  r.setpoint = data_of(setpoint_.pose);
  r.commanded = data_of(commanded_);
  r.velocity = data_of(admittance_.state().velocity);
  r.wrench_raw = data_of(feedback.wrench);
  r.position = measured_;
  r.position_commanded = command.position;
  r.joints_fresh = feedback.joints_fresh;
}

}  // namespace tenon::executor
