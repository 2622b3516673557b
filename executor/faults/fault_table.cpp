#include "executor/faults/fault_table.h"

#include <array>
#include <cmath>

#include "executor/faults/fault_bounds.h"
#include "shared/base/text.h"

namespace tenon::executor {
namespace {

constexpr const char* kFromFault = "the fault";

/// An orderly end: nothing was wrong, or the task itself says what was.
constexpr FaultRow ended(EndReason reason, const char* name, const char* detector,
                         EndManner reaction = EndManner::kHold) {
  return {.reason = reason, .name = name, .detector = detector, .reaction = reaction};
}

constexpr FaultRow fault(EndReason reason, const char* name, const char* detector, FaultBound bound,
                         const char* since = kFromFault,
                         EndManner reaction = EndManner::kQuickStop) {
  return {.reason = reason,
          .name = name,
          .detector = detector,
          .bound = bound,
          .since = since,
          .reaction = reaction};
}

/// Null: there is no such fault.
constexpr const char* arm_fault_name(ArmFaultKind kind) {
  switch (kind) {
    case ArmFaultKind::kNone:
      return nullptr;
    case ArmFaultKind::kNoAnswer:
      return "no_answer";
    case ArmFaultKind::kConfiguration:
      return "configuration";
    case ArmFaultKind::kHeartbeatLost:
      return "heartbeat_lost";
    case ArmFaultKind::kUnexpectedReset:
      return "unexpected_reset";
    case ArmFaultKind::kDriveFault:
      return "drive_fault";
    case ArmFaultKind::kDriveState:
      return "drive_state";
    case ArmFaultKind::kFeedbackMissing:
      return "feedback_missing";
    case ArmFaultKind::kSensorStale:
      return "sensor_stale";
    case ArmFaultKind::kSensorInvalid:
      return "sensor_invalid";
    case ArmFaultKind::kBusDown:
      return "bus_down";
    case ArmFaultKind::kBusOff:
      return "bus_off";
    case ArmFaultKind::kOtherMaster:
      return "other_master";
    case ArmFaultKind::kQueueFull:
      return "queue_full";
    case ArmFaultKind::kBusSilent:
      return "bus_silent";
    case ArmFaultKind::kSetpointNotFinite:
      return "setpoint_not_finite";
    case ArmFaultKind::kSetpointUnsent:
      return "setpoint_unsent";
  }
  return nullptr;
}

constexpr FaultRow of_arm(ArmFaultKind kind, const char* detector, FaultBound bound,
                          const char* since = kFromFault, EndState end_state = EndState::kOff) {
  return {.reason = EndReason::kArmFault,
          .arm_fault = kind,
          .name = "arm_fault",
          .arm_fault_name = arm_fault_name(kind),
          .detector = detector,
          .bound = bound,
          .since = since,
          .reaction = EndManner::kQuickStop,
          .end_state = end_state};
}

// An answer is taken up to a cycle after what it tells, and the decision falls in its cycle.
constexpr FaultBound kAtOnce{.cycles = 2};
// The same of a wrench.
constexpr FaultBound kAtNextSample{.cycles = 1, .samples = 1};
// More than five in a row (hw/arm), told to the executor in the cycle after.
constexpr FaultBound kMissing{.cycles = 8};
constexpr FaultBound kMissingSamples{.cycles = 2, .samples = 6};
constexpr FaultBound kTareTried{.cycles = 2, .samples = kTareTries * kTareSamples};

constexpr std::array kTable = {
    ended(EndReason::kPlanDone, "plan_done", "plan runner"),
    ended(EndReason::kPlanFailed, "plan_failed", "plan runner: outcome and envelope of a step"),
    ended(EndReason::kStopRequested, "stop_requested", "signal", EndManner::kToolRamp),
    ended(EndReason::kNotAtStart, "not_at_start", "tool's pose after the tare"),
    fault(EndReason::kTareUnsteady, "tare_unsteady", "tare: deviation of its samples, five times",
          kTareTried, "the tare's first sample", EndManner::kHold),
    fault(EndReason::kTareMoving, "tare_moving", "tare: way of every joint", kAtOnce,
          "the way that is too far", EndManner::kHold),
    fault(EndReason::kContactOnApproach, "contact_on_approach",
          "wrench beyond the plan's on-thresholds", {.cycles = 1, .samples = kTouchSamples},
          "the touch", EndManner::kToolRamp),
    fault(EndReason::kUnreachable, "unreachable", "inverse kinematics of every setpoint",
          {.cycles = 1}, "the setpoint", EndManner::kJointRamp),
    fault(EndReason::kJointLimit, "joint_limit", "every setpoint, with the way to rest",
          {.cycles = 1}, "the setpoint", EndManner::kJointRamp),
    fault(EndReason::kJointSpeed, "joint_speed", "every setpoint", {.cycles = 1}, "the setpoint",
          EndManner::kJointRamp),
    fault(EndReason::kForceFault, "force_fault",
          "every wrench since the tare; every force as its frame comes", kAtNextSample,
          "the force"),
    fault(EndReason::kTorqueFault, "torque_fault", "every wrench since the tare", kAtNextSample,
          "the torque"),
    fault(EndReason::kSensorSaturated, "sensor_saturated", "every wrench", kAtNextSample),
    fault(EndReason::kSensorNotFinite, "sensor_not_finite", "every wrench", kAtNextSample),
    of_arm(ArmFaultKind::kNoAnswer, "bring-up, before anything has power", {.time_s = 1.0},
           "the request"),
    of_arm(ArmFaultKind::kConfiguration, "bring-up, before anything has power", {.time_s = 1.0},
           "the request"),
    of_arm(ArmFaultKind::kHeartbeatLost, "heartbeat of every node",
           {.cycles = 2, .heartbeat_timeouts = 1}, "the last heartbeat"),
    of_arm(ArmFaultKind::kUnexpectedReset, "boot-up message, or another state in a heartbeat",
           {.cycles = 2, .heartbeat_periods = 1}),
    of_arm(ArmFaultKind::kDriveFault, "statusword of every cycle, EMCY", kAtOnce,
           "the drive's own naming it"),
    of_arm(ArmFaultKind::kDriveState, "statusword of every cycle; while enabling, 2 s", kAtOnce,
           "the drive's leaving operation enabled"),
    of_arm(ArmFaultKind::kFeedbackMissing, "more than 5 cycles in a row without a joint's answer",
           kMissing),
    of_arm(ArmFaultKind::kSensorStale,
           "more than 5 samples in a row without a new, whole wrench that is at most 1 SYNC late",
           kMissingSamples),
    of_arm(ArmFaultKind::kSensorInvalid,
           "a wrench at the end of its range, EMCY or status of the sensor", kAtNextSample),
    of_arm(ArmFaultKind::kBusDown, "transport, every cycle", kAtOnce, kFromFault,
           EndState::kOffByDrives),
    of_arm(ArmFaultKind::kBusOff, "transport, every cycle", kAtOnce, kFromFault,
           EndState::kOffByDrives),
    of_arm(ArmFaultKind::kOtherMaster, "every frame that only a master sends", kAtOnce,
           "the frame"),
    of_arm(ArmFaultKind::kQueueFull, "more than 2 cycles in a row whose frames are refused",
           {.cycles = 5}),
    of_arm(ArmFaultKind::kBusSilent, "more than 3 cycles in a row in which nobody answers",
           {.cycles = 6}),
    of_arm(ArmFaultKind::kSetpointNotFinite, "every setpoint at the arm port", kAtOnce,
           "the setpoint"),
    of_arm(ArmFaultKind::kSetpointUnsent,
           "leaky bucket of each joint's setpoints that never left; one in a hundred may be so",
           {.cycles = 7}, "the first of so many cycles"),
    fault(EndReason::kArmNotEnabled, "arm_not_enabled", "state of the arm, every cycle", kAtOnce),
    fault(EndReason::kEnableTimeout, "enable_timeout", "state of the arm while it is enabled",
          {.cycles = 1, .time_s = kEnableTimeout_s}, "the first cycle", EndManner::kHold),
    fault(EndReason::kFeedbackMissing, "feedback_missing",
          "cycles in a row without a joint's answer", {.cycles = kFeedbackMissesMax + 2}),
    fault(EndReason::kWrenchMissing, "wrench_missing", "age of the wrench",
          {.cycles = 2, .samples = kWrenchSamplesMin, .time_s = kWrenchAgeMax_s}),
    fault(EndReason::kOverruns, "overruns",
          "leaky bucket of late cycles; one in twenty may be late", {.cycles = kLateCyclesMost + 1},
          "the first of so many late cycles"),
    ended(EndReason::kOtherBranch, "other_branch", "joints' positions after the tare"),
    fault(EndReason::kFeedbackPoor, "feedback_poor",
          "leaky bucket of cycles without all answers; one in a hundred may be",
          {.cycles = kIncompleteCyclesMost + 1}, "the first of so many such cycles"),
    ended(EndReason::kMeasured, "measured", "identification"),
    ended(EndReason::kNothingMet, "nothing_met", "identification"),
    FaultRow{.reason = EndReason::kBrakeFailed,
             .name = "brake_failed",
             .detector = "joints' positions after the drives are off, for 0.5 s and for as long as "
                         "one creeps",
             .bound = {.cycles = 2, .time_s = kBrakeCreep_s},
             .since = "the drives' being off",
             .reaction = EndManner::kQuickStop,
             .end_state = EndState::kBrakeSlips},
    fault(EndReason::kFollowingError, "following_error",
          "every joint against all that it was commanded within three lags",
          {.cycles = 2, .time_s = kFollowingPatience_s}, "an error beyond its bound"),
    fault(EndReason::kBlind, "blind", "age of the last sample that guarded moves may see",
          {.cycles = 2, .samples = kBlindSamplesMin, .time_s = kBlindMax_s}),
    fault(EndReason::kTareOffset, "tare_offset",
          "mean of the tare against the cell's sensor_bias and payload", kTareTried,
          "the tare's first sample", EndManner::kHold),
    ended(EndReason::kNotAtGoal, "not_at_goal", "tool's pose at the plan's end against its goal"),
    fault(EndReason::kWrenchFrozen, "wrench_frozen",
          "every wrench against the one before, while its counter runs: all axes for 7 samples, "
          "each by itself",
          {.cycles = 2, .samples = kFrozenAxisSamples}),
    fault(EndReason::kTareDrift, "tare_drift",
          "mean wrench of later samples at rest in free air against the first's: the tare's "
          "halves, five times, and where a step waits",
          kTareTried, "the first sample at rest", EndManner::kHold),
    fault(EndReason::kEncoderJump, "encoder_jump",
          "every joint's way against its commands and its full speed", kAtOnce),
    fault(EndReason::kZeroMoved, "zero_moved",
          "wrench at the plan's end, where no contact is held: two means of 0.2 s against half "
          "the off-thresholds",
          {.cycles = 2, .time_s = kZeroWatch_s}, "the plan's end", EndManner::kHold),
    FaultRow{.reason = EndReason::kNotDisabled,
             .name = "not_disabled",
             .detector = "the drives' own words, once they are told to go off",
             .bound = {.cycles = 2, .time_s = kDisableTimeout_s},
             .since = "the order",
             .reaction = EndManner::kQuickStop,
             .end_state = EndState::kUnknown},
    fault(EndReason::kNotHeld, "not_held",
          "tool's pose against its command, from the plan's end until the brakes hold: half of the "
          "goal's tolerance, in the brakes all of it",
          {.cycles = 2, .time_s = kHeldPatience_s}, "an error beyond that", EndManner::kHold),
    fault(EndReason::kEffortFrozen, "effort_frozen",
          "where efforts tell the force: every joint's effort against the one before, while the "
          "joint moves",
          {.cycles = kFrozenEffortCycles + 2}, "the fault, in cycles of the joint's motion"),
};

constexpr bool every_reason_has_a_row() {
  std::size_t next = 1;  // kNone has none
  for (const FaultRow& row : kTable) {
    const auto reason = static_cast<std::size_t>(row.reason);
    if (reason == next) ++next;
    if (reason >= next) return false;
  }
  return next == static_cast<std::size_t>(kLastEndReason) + 1;
}
static_assert(every_reason_has_a_row());

constexpr bool every_fault_of_the_arm_has_a_row() {
  for (int kind = 1; arm_fault_name(static_cast<ArmFaultKind>(kind)) != nullptr; ++kind) {
    bool found = false;
    for (const FaultRow& row : kTable) found = found || static_cast<int>(row.arm_fault) == kind;
    if (!found) return false;
  }
  return true;
}
static_assert(every_fault_of_the_arm_has_a_row());
static_assert(kTable.size() <= 64, "FaultMask has a bit for each row");

constexpr bool is_bounded(const FaultBound& bound) {
  return bound.cycles > 0 || bound.samples > 0 || bound.time_s > 0.0 ||
         bound.heartbeat_periods > 0 || bound.heartbeat_timeouts > 0;
}

void append(std::string& text, int count, const char* what) {
  if (count == 0) return;
  text += format("%s%d %s%s", text.empty() ? "" : " and ", count, what, plural(count));
}

}  // namespace

std::span<const FaultRow> fault_table() { return kTable; }

const FaultRow* fault_row(EndReason reason, ArmFaultKind arm_fault) {
  for (const FaultRow& row : kTable) {
    if (row.reason == reason && row.arm_fault == arm_fault) return &row;
  }
  return nullptr;
}

const char* to_string(EndReason reason) {
  if (reason == EndReason::kNone) return "none";
  for (const FaultRow& row : kTable) {
    if (row.reason == reason) return row.name;
  }
  return "?";
}

EndManner end_manner(EndReason reason) {
  if (reason == EndReason::kNone) return EndManner::kHold;
  for (const FaultRow& row : kTable) {
    if (row.reason == reason) return row.reaction;
  }
  return EndManner::kQuickStop;  // no such reason: the memory is not what it was
}

std::optional<std::int64_t> bound_cycles(const FaultRow& row, const Robot& robot) {
  if (!is_bounded(row.bound)) return std::nullopt;
  const double waited_s = row.bound.time_s +
                          1e-3 * row.bound.heartbeat_periods * robot.heartbeat_ms +
                          1e-3 * row.bound.heartbeat_timeouts * robot.heartbeat_timeout_ms;
  return row.bound.cycles + std::int64_t{row.bound.samples} * robot.sensor.cycles_per_sample +
         static_cast<std::int64_t>(std::ceil(1e6 * waited_s / robot.cycle_us));
}

std::string full_name(const FaultRow& row) {
  const std::string name = row.name;
  return row.reason == EndReason::kArmFault ? name + ": " + row.arm_fault_name : name;
}

std::string to_string(const FaultBound& bound) {
  std::string text;
  append(text, bound.heartbeat_timeouts, "heartbeat timeout");
  append(text, bound.heartbeat_periods, "heartbeat period");
  if (bound.time_s > 0.0) text += format("%s%g s", text.empty() ? "" : " and ", bound.time_s);
  append(text, bound.samples, "sample");
  append(text, bound.cycles, "cycle");
  return text;
}

const char* to_string(EndManner manner) {
  switch (manner) {
    case EndManner::kHold:
      return "hold";
    case EndManner::kToolRamp:
      return "tool ramps down";
    case EndManner::kJointRamp:
      return "joints ramp down";
    case EndManner::kQuickStop:
      return "drives' quick stop";
  }
  return "?";
}

const char* to_string(EndState state) {
  switch (state) {
    case EndState::kOff:
      return "brakes on, power off";
    case EndState::kOffByDrives:
      return "the same, by the drives themselves once the heartbeat is missed";
    case EndState::kBrakeSlips:
      return "a brake slips; power by the cell's `on_brake_failure`";
    case EndState::kUnknown:
      return "nobody knows: a drive may have power";
  }
  return "?";
}

void FaultMask::mask(EndReason reason, ArmFaultKind arm_fault) {
  const FaultRow* row = fault_row(reason, arm_fault);
  if (row != nullptr) rows_.set(static_cast<std::size_t>(row - kTable.data()));
}

bool FaultMask::masks(EndReason reason, ArmFaultKind arm_fault) const {
  if (rows_.none()) return false;
  const FaultRow* row = fault_row(reason, arm_fault);
  return row != nullptr && rows_.test(static_cast<std::size_t>(row - kTable.data()));
}

}  // namespace tenon::executor
