#include "executor/loop/controller.h"

#include <algorithm>
#include <cmath>

#include "executor/faults/fault_bounds.h"
#include "executor/motion/joint_difference.h"

namespace tenon::executor {
namespace {

// Half of what holds a contact: a zero that is off by less, the thresholds have room for. And
// nothing that noise may make, or that joints do not resolve.
ZeroWatch::Parameters zero_parameters(const Plan& plan, const Cell& cell, double window_s,
                                      const Vector6& resolution) {
  constexpr int kSamplesLeast = 20;
  ZeroWatch::Parameters p;
  p.samples = std::max(kSamplesLeast, static_cast<int>(window_s / sample_period_s(cell.robot)));
  p.axes = plan.compliance.compliant_axes;
  const auto noise = SensorTare::parameters_for(cell.robot.sensor, kTareSamples);
  const double lever_m = compose(inverse(cell.X_FS), cell.X_FP).position_m.norm();
  const double share = DriftWatch::kDeviations * std::sqrt(1.0 / p.samples + 1.0 / kTareSamples);
  const ContactThresholds& t = plan.parameter_sets[plan.steps.back().parameter_set].thresholds;
  const double force_N = std::max(0.5 * t.force_off_N, share * noise.force_deviation_max_N);
  const double torque_Nm =
      std::max(0.5 * t.torque_off_Nm,
               share * (noise.torque_deviation_max_Nm + lever_m * noise.force_deviation_max_N));
  p.bound << Vector3::Constant(force_N), Vector3::Constant(torque_Nm);
  p.bound = p.bound.cwiseMax(resolution);
  return p;
}

/// A tool that moves shakes about twice as much as one that is tared at rest. The zero moves no
/// farther than what the end of a plan takes for zero.
FreeAirZero::Parameters free_zero_parameters(const Cell& cell, const Vector6& bound) {
  constexpr double kInMotion = 2.0;
  const auto noise = SensorTare::parameters_for(cell.robot.sensor, kTareSamples);
  const double lever_m = compose(inverse(cell.X_FS), cell.X_FP).position_m.norm();
  const double force_N = kInMotion * noise.force_deviation_max_N;
  const double torque_Nm = kInMotion * noise.torque_deviation_max_Nm + lever_m * force_N;
  FreeAirZero::Parameters p;
  p.deviation_max << Vector3::Constant(force_N), Vector3::Constant(torque_Nm);
  p.moved_max = bound;
  return p;
}

}  // namespace

Controller::Controller(const Cell& cell, const DryRun& dry_run, const Parameters& parameters)
    : ControlTask(cell, parameters),
      plan_(with_steps(dry_run.plan)),
      start_(dry_run.start),
      done_reach_(done_reach(plan_)),
      parameters_(parameters),
      tool_(plan_.compliance),
      runner_(plan_),
      zero_watch_(zero_parameters(
          plan_, ControlTask::cell(), parameters.hold_s,
          dry_run.steps.empty() ? Vector6(Vector6::Zero()) : dry_run.steps.back().resolution)),
      free_zero_(free_zero_parameters(ControlTask::cell(), zero_watch_.bounds())) {}

// --- states ---------------------------------------------------------------------------------

ControlTask::Turn Controller::on_enter(State state) {
  switch (state) {
    case State::kTaring:
      commanded_ = supervision().tool();
      break;
    case State::kApproaching:
      return start_approach();
    case State::kRunning:
      setpoint_ = {commanded_, Vector6::Zero(), Vector6::Zero()};
      tool_.rest_at(commanded_);
      break;
    case State::kStopping:
      stop_ = StopProfile(setpoint_, parameters_of_step().speeds);
      break;
    case State::kHolding:
      setpoint_.velocity.setZero();
      setpoint_.acceleration.setZero();
      break;
    case State::kWaiting:
    case State::kQuickStopping:
    case State::kDisabling:
    case State::kWatching:
    case State::kCatching:
    case State::kFinished:
      break;
  }
  return {};
}

void Controller::on_ending(const Ending& ending) {
  const bool no_way_on = end_manner(ending.reason) == EndManner::kJointRamp;
  if (no_way_on || state() == State::kApproaching) leave_the_tool();
}

// --- what a state does ----------------------------------------------------------------------

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
  const JointDifference worst = largest_difference(joints().position(), *start_);
  if (worst.value <= parameters_.start_tolerance_joint) return std::nullopt;
  const auto joint = static_cast<std::size_t>(worst.joint);
  return Ending{.reason = EndReason::kOtherBranch,
                .index = worst.joint,
                .value = joints().position()[joint],
                .bound = parameters_.start_tolerance_joint,
                .wanted = (*start_)[joint]};
}

// The plan says done. Whether that can be its goal is seen by the encoders.
Ending Controller::done() const {
  if (!done_reach_) return {.reason = EndReason::kPlanDone};
  const auto gap = goal_gap(plan_, *done_reach_, supervision().tool(),
                            parameters_.start_tolerance_m, parameters_.start_tolerance_rad);
  if (!gap) return {.reason = EndReason::kPlanDone};
  return {.reason = EndReason::kNotAtGoal,
          .index = gap->axis,
          .value = gap->tool,
          .bound = gap->bound,
          .wanted = gap->goal};
}

ControlTask::Turn Controller::start_approach() {
  const std::optional<Ending> off = off_start();
  if (!off) return Event::kAtStart;
  if (!parameters_.go_to_start || !start_) return *off;
  // Within contact speed all the way: its impact is what the plan's check has found harmless.
  approach_ = JointMove(joints().position(), *start_, cell().robot, kinematics(),
                        parameters_of_step().speeds);
  touch_samples_ = 0;
  return {};
}

ControlTask::Turn Controller::approach() {
  const int axis = touching_axis(SerialChain::kAllAxes);
  if (supervision().wrench_usable()) touch_samples_ = axis < 0 ? 0 : touch_samples_ + 1;
  if (touch_samples_ >= kTouchSamples) {
    return Ending{.reason = EndReason::kContactOnApproach,
                  .index = axis,
                  .value = supervision().wrench()[axis],
                  .bound = on_threshold(axis)};
  }
  const bool arrived = time_in_state_s() >= approach_.duration_s() + parameters_.hold_s;
  return arrived ? Turn(Event::kAtStart) : Turn();
}

// A word that was given before the step began to wait was not meant for it.
bool Controller::waits_for_the_user() noexcept {
  const bool gate = parameters_.step_by_step && runner_.between_moves();
  if (gate && !waits_) allowed_.store(false, std::memory_order_relaxed);
  waits_ = gate && !allowed_.load(std::memory_order_relaxed);
  return waits_;
}

// In a contact the wrench may go its own way: who could tell why.
ControlTask::Turn Controller::wait_at_rest() {
  if (runner_.signature().bits != 0) return {};
  if (const auto drift = wait_in_free_air()) return *drift;
  return {};
}

// A move knows no pause: its time runs slower, and it replays from a trace as it was. It still sees
// every sample, and stops pressing at the first that is a touch; what it decides, it decides once
// its time runs again.
void Controller::pass_time() {
  pace_.update(paused_.load(std::memory_order_relaxed), parameters_of_step().speeds, cycle_s());
  const double share = pace_.share();
  const std::int64_t cycle_ns = std::llround(1e9 * cycle_s());
  const std::int64_t passed_ns =
      share < 1.0 ? std::llround(share * static_cast<double>(cycle_ns)) : cycle_ns;
  move_ns_ += std::max<std::int64_t>(1, passed_ns);
}

ControlTask::Turn Controller::run(const ArmFeedback& /*feedback*/) {
  if (waits_for_the_user()) return wait_at_rest();
  leave_free_air();
  GuardedMove::Input input;
  pass_time();
  input.time_ns = move_ns_;
  input.pose = tool_.seen(supervision().tool());
  input.wrench = supervision().wrench();
  input.wrench_fresh = supervision().wrench_usable();
  const GuardedMove::Output output = runner_.update(input);
  setpoint_ = output.setpoint;
  if (const double pace = pace_.share(); pace < 1.0) {
    // By the clock, not by the move's own time.
    setpoint_.acceleration =
        pace * pace * setpoint_.acceleration + pace_.rate() * setpoint_.velocity;
    setpoint_.velocity *= pace;
  }
  phase_ = output.phase;
  seen_ = input.pose;
  follow_zero();
  switch (runner_.status()) {
    case PlanRunner::Status::kRunning:
      return {};
    case PlanRunner::Status::kDone:
      return done();
    case PlanRunner::Status::kFailed: {
      const StepReport& last = runner_.report(runner_.report_count() - 1);
      return Ending{.reason = EndReason::kPlanFailed,
                    .index = static_cast<int>(last.step),
                    .transition = last.transition};
    }
  }
  return {};
}

// The wrench of this cycle is what the move has seen; the zero moves for the next one.
void Controller::follow_zero() {
  const bool held = runner_.signature_before().bits != 0;
  if (runner_.move_started()) free_zero_.begin(!held);
  if (runner_.signature().bits != 0 || phase_ == GuardedMove::Phase::kProbing) free_zero_.touch();
  if (supervision().wrench_usable()) free_zero_.add(supervision().contact_at_sensor());
  if (phase_ != GuardedMove::Phase::kDone) return;
  const StepReport& last = runner_.report(runner_.report_count() - 1);
  if (last.result.outcome != Outcome::kReached) return;
  if (const auto moved = free_zero_.end()) move_zero(*moved);
}

ControlTask::Turn Controller::ramp_down() {
  // Into a contact there is no ramping.
  if (touching_axis(tool_left_ ? SerialChain::kAllAxes : plan_.compliance.compliant_axes) >= 0) {
    yield_here();
    return Event::kAtRest;
  }
  if (tool_left_) return joints().at_rest() ? Turn(Event::kAtRest) : Turn();
  // The profile begins with the setpoint of the cycle before.
  const double time_s = time_in_state_s() + cycle_s();
  setpoint_ = stop_.at(time_s);
  return time_s >= stop_.duration_s() ? Turn(Event::kAtRest) : Turn();
}

// A plan that is done has brought the tool where it was told. How far a joint may stay behind in
// motion is its drive's to say, and may be more than the goal allows: here, by no more than that
// share of its tolerances. Empty for a plan without goal.
std::optional<Ending> Controller::off_command(double share) const {
  if (plan_.goal_tolerance_m <= 0.0) return std::nullopt;
  // Any end may do along an axis, but a tool that leaves its command is not held.
  GoalAxes axes = plan_.goal_axes;
  axes.free = 0;
  const Pose told = kinematics().tool(joints().position());
  const Vector6 off = displacement_between(told, supervision().tool());
  const bool far = tolerances_off(off, plan_.goal_tolerance_m, axes, 0.0) > share ||
                   off.tail<3>().norm() > parameters_.start_tolerance_rad;
  if (!far) return std::nullopt;
  double narrowest_m = plan_.goal_tolerance_m;
  for (const double own_m : axes.tolerance.head<3>()) {
    if (own_m > 0.0) narrowest_m = std::min(narrowest_m, own_m);
  }
  const JointDifference worst = largest_difference(supervision().joints(), joints().position());
  return Ending{.reason = EndReason::kNotHeld,
                .index = worst.joint,
                .value = worst.value,
                .bound = share * narrowest_m};
}

// The half of the goal's tolerance that plans leave to their arms.
std::optional<Ending> Controller::watch_hold() {
  const auto off = off_command(0.5);
  unheld_cycles_ = off ? unheld_cycles_ + 1 : 0;
  return unheld_cycles_ * cycle_s() > kHeldPatience_s ? off : std::nullopt;
}

// A brake lets its joint go a little before it holds.
std::optional<Ending> Controller::seen_in_brakes() {
  if (ending().reason != EndReason::kPlanDone) return std::nullopt;
  return off_command(1.0);
}

// A plan that ends in free air is done only if it is free air: a zero that has moved meanwhile has
// shifted whatever was met on the way. In a contact nobody can tell.
ControlTask::Turn Controller::hold() {
  if (ending().reason == EndReason::kPlanDone && !unheld_told_) {
    if (const auto off = watch_hold()) {
      unheld_told_ = true;
      return *off;
    }
  }
  const bool free = ending().reason == EndReason::kPlanDone && runner_.signature().bits == 0;
  if (!free || zero_told_ || time_in_state_s() >= kZeroWatch_s) return held();
  if (supervision().wrench_usable()) {
    const Vector6 moved = supervision().at_tool(free_zero_.moved());
    (void)zero_watch_.add(supervision().wrench() + moved);
  }
  switch (zero_watch_.status()) {
    case ZeroWatch::Status::kLooking:
      return {};
    case ZeroWatch::Status::kZero:
      return held();
    case ZeroWatch::Status::kMoved:
      zero_told_ = true;
      return Ending{.reason = EndReason::kZeroMoved,
                    .index = zero_watch_.axis(),
                    .value = zero_watch_.mean(),
                    .bound = zero_watch_.bound()};
  }
  return {};
}

// --- giving out -----------------------------------------------------------------------------

double Controller::on_threshold(int axis) const {
  const ContactThresholds& on = parameters_of_step().thresholds;
  return axis < 3 ? on.force_on_N : on.torque_on_Nm;
}

// One of the axes that is above its on-threshold, or -1.
int Controller::touching_axis(std::uint8_t axes) const {
  for (int axis = 0; axis < 6; ++axis) {
    if ((axes >> axis & 1U) == 0) continue;
    if (std::abs(supervision().wrench()[axis]) > on_threshold(axis)) return axis;
  }
  return -1;
}

// The joints ramp down from where they are.
void Controller::leave_the_tool() {
  if (tool_left_) return;
  tool_left_ = true;
  joints().stop();
}

// The setpoint is where the tool is, and the tool compliant.
void Controller::yield_here() {
  if (tool_left_) {
    joints().rest_at(joints().position());
    tool_.rest_at(commanded_);
    tool_left_ = false;
  }
  setpoint_ = {tool_.commanded().pose, Vector6::Zero(), Vector6::Zero()};
}

std::optional<Ending> Controller::command_joints() {
  if (tool_left_) return std::nullopt;
  if (state() == State::kApproaching) return joints().follow(approach_.at(time_in_state_s()));
  std::optional<Ending> refused =
      joints().follow(tool_.update(setpoint_, supervision().wrench(), cycle_s()).pose);
  if (refused && state() == State::kRunning) refused->step = static_cast<int>(runner_.step());
  return refused;
}

Vector6 Controller::complete_motion() {
  if (tool_left_) {
    joints().ramp();
  } else if (state() != State::kApproaching) {
    commanded_ = tool_.commanded().pose;
    return tool_.commanded().velocity;
  }
  commanded_ = kinematics().tool(joints().position());
  setpoint_ = {commanded_, Vector6::Zero(), Vector6::Zero()};
  return kinematics().twist(joints().position(), joints().velocity());
}

void Controller::write_motion(CycleRecord& r) {
  r.moving = seen_.has_value();
  r.move_started = r.moving && runner_.move_started();
  if (seen_) r.pose = data_of(*seen_);
  seen_.reset();
  r.phase = phase_;
  r.move_ns = move_ns_;
  r.pace = pace_.share();
  const bool awaits = waits_ && state() == State::kRunning;
  r.awaited_step = awaits ? static_cast<std::int32_t>(runner_.next_step()) : -1;
  r.step = r.moving ? static_cast<std::int32_t>(runner_.step()) : -1;
  r.steps_done = static_cast<std::uint32_t>(runner_.report_count());
  r.signature_before = runner_.signature_before().bits;
  r.signature = runner_.signature().bits;
  r.setpoint = data_of(setpoint_.pose);
  r.commanded = data_of(commanded_);
}

}  // namespace tenon::executor
