#include "executor/loop/supervision.h"

#include <algorithm>
#include <cmath>

namespace tenon::executor {

Supervision::Supervision(const Cell& cell, const ToolKinematics& kinematics,
                         const Parameters& parameters)
    : cell_(cell),
      kinematics_(kinematics),
      parameters_(parameters),
      wrench_(cell),
      frozen_watch_(cell.robot.sensor),
      following_watch_(cell.robot),
      encoder_watch_(cell.robot) {
  // The arm counts a sensor's silence in cycles, and knows its node: where cycles are long, too, it
  // is to be heard first.
  const double sample_s = sample_period_s(cell.robot);
  parameters_.wrench_age_max_s =
      std::max(parameters_.wrench_age_max_s, kWrenchSamplesMin * sample_s);
  parameters_.blind_max_s = std::max(parameters_.blind_max_s, kBlindSamplesMin * sample_s);
}

std::optional<Ending> Supervision::update(const ArmFeedback& feedback, bool following) {
  const std::optional<Ending> jumped = take_joints(feedback);
  const std::optional<Ending> sensor = take_wrench(feedback);
  const std::optional<Ending> arm = watch_arm(feedback, following);
  const std::optional<Ending> astray = watch_following(feedback, following);
  const std::optional<Ending> force = watch_force(feedback);
  // A jump first: what it leads to is felt and seen later.
  if (jumped) return jumped;
  if (sensor) return with_laggard(*sensor);
  // At the end of its range it is none, and the arm says so.
  const bool believed = feedback.fault.kind != ArmFaultKind::kSensorInvalid;
  if (believed && feedback.force_stopped_N > 0.0) {
    return with_laggard({.reason = EndReason::kForceFault,
                         .value = feedback.force_stopped_N,
                         .bound = cell_.force_fault_N});
  }
  if (arm) return arm;
  return force ? force : astray;
}

std::optional<Ending> Supervision::tare(const Vector6& mean_raw) {
  wrench_.tare(mean_raw, tool_);
  if (const auto& known = cell_.sensor_bias) {
    for (int axis = 0; axis < 6; ++axis) {
      const double bound = axis < 3 ? known->force_tolerance_N : known->torque_tolerance_Nm;
      const double found = wrench_.bias()[axis];
      if (std::abs(found - known->wrench[axis]) <= bound) continue;
      return Ending{.reason = EndReason::kTareOffset,
                    .index = axis,
                    .value = found,
                    .bound = bound,
                    .wanted = known->wrench[axis]};
    }
  }
  tared_ = true;
  return std::nullopt;
}

std::optional<Ending> Supervision::take_joints(const ArmFeedback& feedback) {
  bool all = true;
  for (std::size_t i = 0; i < cell_.robot.joints.size(); ++i) {
    const bool fresh =
        (feedback.joints_fresh >> i & 1U) != 0 && std::isfinite(feedback.position[i]);
    all = all && fresh;
    misses_[i] = fresh ? 0 : misses_[i] + 1;
    if (fresh) joints_[i] = feedback.position[i];
  }
  known_ = known_ || all;
  if (known_) tool_ = kinematics_.tool(joints_);
  const auto jump = encoder_watch_.update(joints_, feedback.joints_fresh, feedback.sync_ns);
  if (!jump) return std::nullopt;
  return Ending{.reason = EndReason::kEncoderJump,
                .index = jump->joint,
                .value = jump->moved,
                .bound = jump->bound};
}

std::optional<Ending> Supervision::take_wrench(const ArmFeedback& feedback) {
  wrench_age_s_ = feedback.wrench_fresh ? 0.0 : wrench_age_s_ + 1e-6 * cell_.robot.cycle_us;
  wrench_usable_ = feedback.wrench_fresh && distrusted_cycles_ == 0;
  if (distrusted_cycles_ > 0) --distrusted_cycles_;
  const bool blind = tared_ && !wrench_usable_;
  blind_s_ = blind ? blind_s_ + 1e-6 * cell_.robot.cycle_us : 0.0;
  // Between two samples of a slow sensor none is missed.
  const double sample_s = sample_period_s(cell_.robot);
  blind_cycles_ += blind_s_ > sample_s - 0.5e-6 * cell_.robot.cycle_us ? 1 : 0;
  if (!feedback.wrench_fresh || !known_) return std::nullopt;
  const auto frozen = frozen_watch_.update(feedback.wrench, feedback.wrench_counter);
  switch (wrench_.update(feedback.wrench, tool_)) {
    case WrenchEstimator::Status::kGood:
      if (!frozen) return std::nullopt;
      return Ending{.reason = EndReason::kWrenchFrozen,
                    .index = frozen->axis,
                    .value = static_cast<double>(frozen->samples)};
    case WrenchEstimator::Status::kSaturated: {
      const int axis = wrench_.axis();
      const ForceTorqueSensor& sensor = cell_.robot.sensor;
      return Ending{.reason = EndReason::kSensorSaturated,
                    .index = axis,
                    .value = feedback.wrench[axis],
                    .bound = axis < 3 ? sensor.force_range_N : sensor.torque_range_Nm};
    }
    case WrenchEstimator::Status::kNotFinite:
      return Ending{.reason = EndReason::kSensorNotFinite};
  }
  return std::nullopt;
}

std::optional<Ending> Supervision::watch_arm(const ArmFeedback& feedback, bool following) const {
  if (feedback.state == ArmState::kFault) {
    return Ending{.reason = EndReason::kArmFault, .arm_fault = feedback.fault};
  }
  if (!following) return std::nullopt;
  if (feedback.state != ArmState::kEnabled) {
    return Ending{.reason = EndReason::kArmNotEnabled, .index = static_cast<int>(feedback.state)};
  }
  for (std::size_t i = 0; i < cell_.robot.joints.size(); ++i) {
    if (misses_[i] <= parameters_.feedback_misses_max) continue;
    return Ending{.reason = EndReason::kFeedbackMissing,
                  .index = static_cast<int>(i),
                  .value = static_cast<double>(misses_[i]),
                  .bound = static_cast<double>(parameters_.feedback_misses_max)};
  }
  if (wrench_age_s_ > parameters_.wrench_age_max_s) {
    return Ending{.reason = EndReason::kWrenchMissing,
                  .value = wrench_age_s_,
                  .bound = parameters_.wrench_age_max_s};
  }
  if (blind_s_ > parameters_.blind_max_s) {
    return Ending{.reason = EndReason::kBlind, .value = blind_s_, .bound = parameters_.blind_max_s};
  }
  return std::nullopt;
}

std::optional<Ending> Supervision::watch_following(const ArmFeedback& feedback, bool following) {
  if (!following) {
    following_watch_.rest_at(joints_);
    return std::nullopt;
  }
  const auto excess = following_watch_.update(joints_, feedback.joints_fresh);
  if (!excess) return std::nullopt;
  return Ending{.reason = EndReason::kFollowingError,
                .index = excess->joint,
                .value = excess->error,
                .bound = excess->bound};
}

ForceLimit Supervision::force_limit() const {
  if (!tared_) return {};
  return {wrench_.unloaded_N(), cell_.force_fault_N};
}

std::optional<Ending> Supervision::watch_force(const ArmFeedback& feedback) {
  if (!tared_ || !feedback.wrench_fresh) return std::nullopt;
  const double force_N = wrench_.external().head<3>().norm();
  const double torque_Nm = wrench_.external().tail<3>().norm();
  peak_force_N_ = std::max(peak_force_N_, force_N);
  peak_torque_Nm_ = std::max(peak_torque_Nm_, torque_Nm);
  if (force_N > cell_.force_fault_N) {
    return with_laggard(
        {.reason = EndReason::kForceFault, .value = force_N, .bound = cell_.force_fault_N});
  }
  if (torque_Nm > cell_.torque_fault_Nm) {
    return with_laggard(
        {.reason = EndReason::kTorqueFault, .value = torque_Nm, .bound = cell_.torque_fault_Nm});
  }
  return std::nullopt;
}

// A joint that stays behind leads the tool astray before it is too far off itself.
Ending Supervision::with_laggard(Ending ending) const {
  const bool too_large = ending.reason == EndReason::kForceFault ||
                         ending.reason == EndReason::kTorqueFault ||
                         ending.reason == EndReason::kSensorSaturated;
  if (!too_large) return ending;
  if (const auto laggard = following_watch_.laggard()) {
    ending.laggard = laggard->joint;
    ending.lag = laggard->error;
  }
  return ending;
}

}  // namespace tenon::executor
