#pragma once
// Watches a run cycle by cycle: when a fault can be seen, and when the run ends for one.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "executor/faults/fault_table.h"
#include "executor/record/cycle_record.h"
#include "executor/record/cycle_sink.h"
#include "shared/cell/cell.h"
#include "sim/cell/virtual_arm/truth.h"

namespace tenon::tests {

/// Watches every cycle: when a fault can be seen, and when the run ends for one. Counts from 1.
class FaultWatch final : public executor::CycleSink {
 public:
  /// @param of_sensor the fault is the sensor's: what it tells is false
  FaultWatch(const Cell& cell, bool of_sensor, std::function<sim::Truth()> truth)
      : robot_(cell.robot),
        force_fault_N_(cell.force_fault_N),
        falls_(!cell.robot.brakes),
        of_sensor_(of_sensor),
        truth_(std::move(truth)) {
    const double lags = 3.0 * robot_.response_lag_s / (1e-6 * robot_.cycle_us);
    window_ = static_cast<std::size_t>(std::ceil(lags)) + 4;
  }

  /// Something stands in the way of the tool: it is met there. @param sign of the way to it
  void expect_post(int axis, double sign, double at_m) { post_ = Post{axis, sign, at_m}; }

  /// The fault has struck: in the cycle that is over, or will do so in the next.
  void struck(bool in_the_last) {
    if (struck_) return;
    struck_ = in_the_last ? cycles_ : cycles_ + 1;
    if (in_the_last) look_at_the_truth();
  }
  void record(const executor::CycleRecord& r) noexcept override {
    ++cycles_;
    if (struck_ && !behind_ && behind(r)) behind_ = cycles_;
    if (struck_) look_at_the_truth();
    if (falls_ && !let_go_) look_while_held(r);
    const bool on = r.arm_state == ArmState::kEnabled && r.request == ArmRequest::kEnabled;
    if (struck_ && on && !followed_) followed_ = cycles_;
    if (struck_ && !named_ && !over_) count_motion(r);
    if (r.state == executor::State::kTaring && !taring_) taring_ = cycles_;
    if (on && was_on_) look_at_commands(r);
    if (struck_ && post_ && !met_) {
      const double tool_m = truth_().tool.position_m[post_->axis];
      if (post_->sign * (tool_m - post_->at_m) >= -kMet_m) met_ = cycles_;
    }
    was_on_ = on;
    commands_.push_front(r.position_commanded);
    if (commands_.size() > window_) commands_.pop_back();
    const auto reason = static_cast<executor::EndReason>(r.end_reason);
    const bool ended = reason != executor::EndReason::kNone &&
                       reason != executor::EndReason::kStopRequested &&
                       reason != executor::EndReason::kPlanDone;
    if (ended && !named_) named_ = cycles_;
    if (r.state >= executor::State::kDisabling && !over_) over_ = cycles_;
    if (r.state == executor::State::kWatching && !off_) off_ = cycles_;
    if (r.state > executor::State::kTaring && r.state <= executor::State::kHolding && !tared_)
      tared_ = cycles_;
  }

  /// Where the bound of a row counts from; unset: that never was, or only the executor can tell.
  [[nodiscard]] std::optional<std::int64_t> since(const executor::FaultRow& row) const {
    using enum executor::EndReason;
    const executor::EndReason reason = row.reason;
    if (reason == kFollowingError) return behind_;
    if (reason == kBrakeFailed) return off_;
    // Cycles in which the joint rests do not count.
    if (reason == kEffortFrozen) return named_.value_or(over_.value_or(cycles_)) - moved_;
    // Of these a joint's way to rest, at its own acceleration, and the truth tell.
    if (reason == kJointLimit) return past_;
    if (reason == kPlanFailed) return met_;
    // Setpoints count from where drives follow them.
    if (row.arm_fault == ArmFaultKind::kSetpointNotFinite) return followed_;
    // Later than the tare's, drift is felt as a force.
    if (reason == kTareDrift) return struck_ && taring_ >= struck_ ? taring_ : std::nullopt;
    if (row.arm_fault == ArmFaultKind::kDriveFault || row.arm_fault == ArmFaultKind::kDriveState) {
      const bool let_go = let_go_at_ && struck_ && *let_go_at_ >= *struck_;
      return left_ || !let_go ? left_ : let_go_at_;
    }
    // What is there while the sensor is tared is no force.
    const bool forged = of_sensor_ && struck_ && tared_ && *tared_ <= *struck_;
    if (reason == kForceFault) return forged ? struck_ : pressed_;
    const bool of_wrench = reason == kTorqueFault || reason == kSensorSaturated ||
                           row.arm_fault == ArmFaultKind::kSensorInvalid;
    const bool inside = reason == kTareMoving || reason == kNotHeld;
    return inside || (of_wrench && !of_sensor_) ? std::nullopt : struck_;
  }
  [[nodiscard]] std::optional<std::int64_t> named() const { return named_; }
  [[nodiscard]] std::optional<std::int64_t> off() const { return off_; }
  /// The run's end stands: no fault that comes later changes its name.
  [[nodiscard]] std::optional<std::int64_t> over() const { return over_; }
  /// The greatest speed commanded to an enabled joint, of its own.
  [[nodiscard]] double fastest() const { return fastest_; }
  /// By which a command to an enabled joint was beyond its limits at most, m or rad.
  [[nodiscard]] double beyond_limit() const { return beyond_limit_; }
  [[nodiscard]] bool has_struck() const { return struck_.has_value(); }
  [[nodiscard]] std::int64_t cycles() const { return cycles_; }
  /// Cycles for which the fault may have acted while the drives were on.
  [[nodiscard]] std::int64_t since_struck() const {
    return struck_ ? off_.value_or(cycles_) - *struck_ : 0;
  }

  /// As it stands; of an arm that falls without power, before a motor of it was off.
  [[nodiscard]] sim::Truth truth_held() const { return held_ ? *held_ : truth_(); }

 private:
  static constexpr double kMet_m = 5e-5;

  struct Post {
    int axis = 0;
    double sign = 0.0;
    double at_m = 0.0;
  };

  void look_at_commands(const executor::CycleRecord& r) {
    const double cycle_s = 1e-6 * robot_.cycle_us;
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
      const Joint& joint = robot_.joints[i];
      const double at = r.position_commanded[i];
      const double speed = (at - commands_.front()[i]) / cycle_s;
      fastest_ = std::max(fastest_, std::abs(speed) / joint.speed_max);
      beyond_limit_ = std::max({beyond_limit_, at - joint.upper, joint.lower - at});
      const double rest = at + speed * std::abs(speed) / (2.0 * joint.acceleration_max);
      if ((rest > joint.upper || rest < joint.lower) && !past_ && !named_) past_ = cycles_;
    }
  }
  /// Of the first joint, which faults strike, by two counts of its encoder.
  void count_motion(const executor::CycleRecord& r) {
    const double counts = 2.0 / std::abs(robot_.joints.front().counts_per_unit);
    if (std::abs(r.position[0] - moved_to_) < counts) return;
    moved_to_ = r.position[0];
    ++moved_;
  }
  void look_while_held(const executor::CycleRecord& r) {
    const sim::Truth truth = truth_();
    const bool on = std::all_of(truth.drives.begin(), truth.drives.end(),
                                [](const sim::DriveTruth& drive) { return drive.state == "on"; });
    were_on_ = were_on_ || on;
    let_go_ = were_on_ && !on;
    if (!let_go_) held_ = truth;
    if (let_go_ && asked_on_) let_go_at_ = cycles_;
    asked_on_ = r.request == ArmRequest::kEnabled;
  }
  void look_at_the_truth() {
    if ((left_ || named_) && pressed_) return;
    const sim::Truth truth = truth_();
    // What a drive shows that is neither being enabled nor enabled.
    const bool left =
        std::any_of(truth.drives.begin(), truth.drives.end(), [](const sim::DriveTruth& drive) {
          return drive.state != "operation enabled" && drive.state != "switched on" &&
                 drive.state != "ready to switch on" && drive.state != "on" && drive.state != "off";
        });
    // Once the run has its name, a drive leaves because it is told to.
    if (left && !left_ && !named_) left_ = cycles_;
    if (truth.contact_force_N_max > force_fault_N_ && !pressed_) pressed_ = cycles_;
  }
  [[nodiscard]] bool behind(const executor::CycleRecord& r) const {
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const JointVector& command : commands_) {
        nearest = std::min(nearest, std::abs(command[i] - r.position[i]));
      }
      if (!commands_.empty() && nearest > robot_.joints[i].following_error_max) return true;
    }
    return false;
  }

  const Robot& robot_;
  double force_fault_N_;
  bool falls_;
  bool were_on_ = false;                   ///< all motors of an arm that falls
  std::optional<std::int64_t> let_go_at_;  ///< and nobody had asked it to
  bool asked_on_ = false;                  ///< in the last cycle
  bool let_go_ = false;                    ///< then one of them was off
  std::optional<sim::Truth> held_;
  bool was_on_ = false;
  double fastest_ = 0.0;
  double beyond_limit_ = 0.0;
  std::optional<Post> post_;
  std::optional<std::int64_t> met_;   ///< the post, by the truth
  std::optional<std::int64_t> past_;  ///< its limit a joint could not stop before any more
  bool of_sensor_;
  std::function<sim::Truth()> truth_;
  std::size_t window_;
  std::deque<JointVector> commands_;
  std::int64_t cycles_ = 0;
  std::optional<std::int64_t> struck_;
  std::int64_t moved_ = 0;  ///< cycles since it struck in which the joint moved
  double moved_to_ = 0.0;
  std::optional<std::int64_t> behind_;
  std::optional<std::int64_t> left_;
  std::optional<std::int64_t> pressed_;
  std::optional<std::int64_t> taring_;
  std::optional<std::int64_t> tared_;
  std::optional<std::int64_t> followed_;
  std::optional<std::int64_t> named_;
  std::optional<std::int64_t> over_;
  std::optional<std::int64_t> off_;
};

}  // namespace tenon::tests
